#!/usr/bin/env bash
# with_kernel.sh DIR COMMAND [ARG...]: runs run-in-can-vm; before, updates the package list for its kernel if necessary.
set -euo pipefail
cache=${CAN_VM_CACHE:-$HOME/.cache/can-vm}
run=$(dirname "$0")/run-in-can-vm
mkdir -p "$cache"
(
  flock 9  # the second of two concurrent runs finds the kernel
  if [ ! -e "$cache/vmlinux" ]; then
    apt-cache show linux-image-amd64 >/dev/null 2>&1 || apt-get -qq update
    "$run" "$cache" true
  fi
) 9>"$cache/lock"
exec "$run" "$@"
