#!/usr/bin/env bash
# with_kernel.sh DIR COMMAND [ARG...]: run-in-can-vm, after making sure that the package list it takes its kernel from is there.
set -euo pipefail
cache=${CAN_VM_CACHE:-$HOME/.cache/can-vm}
run=$(dirname "$0")/run-in-can-vm
mkdir -p "$cache"
(
  flock 9  # of two at once the second one finds the kernel
  if [ ! -e "$cache/vmlinux" ]; then
    apt-cache show linux-image-amd64 >/dev/null 2>&1 || apt-get -qq update
    "$run" "$cache" true
  fi
) 9>"$cache/lock"
exec "$run" "$@"
