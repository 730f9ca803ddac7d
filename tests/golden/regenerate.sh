#!/usr/bin/env bash
# Updates generated/ from the EDS files of the reference devices, the templates and edsc.
#   tests/golden/regenerate.sh [EDSC]      EDSC: build/test/generator/edsc by default
set -euo pipefail
cd "$(dirname "$0")/../.."
edsc=${1-build/test/generator/edsc}
for sheet in eds/*.eds; do
  "$edsc" generate "$sheet" -o generated
done
