#!/usr/bin/env bash
set -euo pipefail
cd "$(dirname "$0")"

help() {
  cat <<'HELP'
./test.sh [GEAR]...: tests edsc; installs missing Debian packages first.

  gates     format, includes, words, schemas, names of types; what differs from origin/main compiles alone and passes clang-tidy
            (less than 2 minutes; needs no build)
  sources   each source and public header compiles alone and passes clang-tidy; each gate detects a planted fault
  quick     the gates; the generated code, the short tests of the command line, the conformance test of the reference
            devices; the unit and trace tests (about 3 minutes after a build)
  test      a release build with all tests but those of the other gears
  asan      the GoogleTest programs (unit and trace tests) and a short run of each fuzz target with AddressSanitizer
            and UBSan
  firmware  the images of the reference devices for Cortex-M under QEMU
  odr       no two sources of edsc define different types of one name (g++ with -flto)
  long      before a release: odr; the static program, and what it writes in an empty root folder compared with the release
            build; each header of the runtime alone; each fuzz target for a minute

Without a gear: gates, test, asan, firmware. The last two use the program edsc of the release build, and build it there
if it is missing. The time of each test is printed at the end of a gear, slowest first.
HELP
}

# run PRESET: a workflow preset and the times of its tests.
run() {
  local build=build/$1 status=0
  case $1 in
    gates | sources | quick | long) build=build/test ;;
    unit | long-asan) build=build/asan ;;
  esac
  rm -f "$build/times-$1.xml"
  echo "== $1"
  cmake --workflow --preset "$1" || status=$?
  .ci/test-times "$build/times-$1.xml"
  return $status
}

gears=("$@")
[ $# -gt 0 ] || gears=(gates test asan firmware)
for gear in "${gears[@]}"; do
  case $gear in
    gates | sources | quick | odr | test | asan | firmware | long) ;;
    -h | --help) help; exit ;;
    *) echo "unknown gear $gear; see ./test.sh --help" >&2; exit 2 ;;
  esac
done

.ci/install-packages test
for gear in "${gears[@]}"; do
  case $gear in
    quick) for part in gates quick unit; do run "$part"; done ;;
    long)
      cmake --workflow --preset static
      for part in odr long long-asan; do run "$part"; done
      ;;
    *) run "$gear" ;;
  esac
done
