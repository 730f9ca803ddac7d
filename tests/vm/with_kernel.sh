#!/usr/bin/env bash
# with_kernel.sh DIR COMMAND [ARG...]: run-in-can-vm, after making sure that the package list it takes its kernel from is there.
set -euo pipefail
cache=${CAN_VM_CACHE:-$HOME/.cache/can-vm}
if [ ! -e "$cache/vmlinux" ] && ! apt-cache show linux-image-amd64 >/dev/null 2>&1; then
  apt-get -qq update
fi
exec "$(dirname "$0")/run-in-can-vm" "$@"
