#!/usr/bin/env bash
# Runs the whole test suite: all tests with a release build; the unit and trace tests and a short run of each fuzz
# target with AddressSanitizer and UBSan; the images of the reference devices for Cortex-M under QEMU.
#   ./test.sh           all parts
#   ./test.sh test      only the release build
#   ./test.sh asan      only the sanitizers
#   ./test.sh firmware  only the images
# The last two use the program edsc of the release build, and build it there if it is missing.
set -euo pipefail
cd "$(dirname "$0")"

.ci/install-packages test
presets=("$@")
[ $# -gt 0 ] || presets=(test asan firmware)
for preset in "${presets[@]}"; do
  echo "== $preset"
  cmake --workflow --preset "$preset"
done
