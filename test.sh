#!/usr/bin/env bash
# Runs the whole test suite: as built for use, then under AddressSanitizer and UBSan the unit and trace tests, and a
# short run of each fuzz target.
#   ./test.sh           everything
#   ./test.sh test      only the first part
#   ./test.sh asan      only the part with sanitizers
set -euo pipefail
cd "$(dirname "$0")"

.ci/install-packages test
presets=("$@")
[ $# -gt 0 ] || presets=(test asan)
for preset in "${presets[@]}"; do
  echo "== $preset"
  cmake --workflow --preset "$preset"
done
