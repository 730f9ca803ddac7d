#!/usr/bin/env bash
# Builds the demo and runs it: generates eight devices and runs five of them with a master on a simulated bus.
set -euo pipefail
cd "$(dirname "$0")"

.ci/install-packages build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if [ -x build/demo/examples/demo/demo ]; then
  echo "Building (build/demo) ..."
else
  echo "Building (build/demo): some minutes the first time ..."
fi
cmake --workflow --preset demo >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
exec build/demo/examples/demo/demo "$@"
