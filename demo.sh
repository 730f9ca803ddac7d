#!/usr/bin/env bash
# Builds edsc and runs the demo: generates eight devices and runs five of them with a master on a simulated bus.
set -euo pipefail
cd "$(dirname "$0")"

.ci/install-packages build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "Building (build/demo) ..."
cmake --workflow --preset demo >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
exec build/demo/examples/demo/demo "$@"
