#!/usr/bin/env bash
# Runs the whole test suite: as built for use, then under AddressSanitizer and UBSan the unit and trace tests, and a
# short run of each fuzz target; then images of the reference devices for Cortex-M under QEMU.
#   ./test.sh           everything
#   ./test.sh test      only the first part
#   ./test.sh asan      only the part with sanitizers
#   ./test.sh firmware  only the images
# The last two take the command edsc from the build of the first, where they build it if it is not there.
set -euo pipefail
cd "$(dirname "$0")"

.ci/install-packages test
presets=("$@")
[ $# -gt 0 ] || presets=(test asan firmware)
for preset in "${presets[@]}"; do
  echo "== $preset"
  cmake --workflow --preset "$preset"
done
