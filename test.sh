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
  asan      the GoogleTest programs (unit and trace tests) and a short run of some fuzz targets with AddressSanitizer
            and the checks of UBSan that compile fast
  firmware  the images of the reference devices under QEMU, which take turns at the Cortex-M0+, the M3 and the M4
  odr       no two sources of edsc define different types of one name (g++ with -flto)
  long      before a release: odr; the packages of the static programs for x86-64 and Arm, what the programs write in an empty
            root folder compared with the release build, and the packages of builds in two folders; edsc.exe under wine with all
            files of the repository; a cold demo; projects that compile edsc, and what they rebuild; each header of the runtime
            alone; the headers of 65,000 entries and of 1024 PDOs with both compilers; what is generated for each file of the
            corpus; `edsc node` with each of them; each planted fault of a device; each image for each board; plants in a virtual
            machine with SocketCAN; the whole page of footprints; ten hours of each plant under `edsc watch`; each wrong program
            and value with both compilers; the programs of asan with all checks of UBSan, each fuzz target for a minute

Without a gear: gates, test, asan, firmware. The last two use the program edsc of the release build, and build it there
if it is missing. They are built while tests of the release build wait; the output is in build/ahead.log. The time of each test
is printed at the end of a gear, slowest first.
HELP
}

# Seconds on two processors: of a build from nothing, and of the tests.
declare -A build_seconds=([gates]=0 [sources]=0 [quick]=700 [unit]=500 [odr]=300 [test]=520 [asan]=400 [firmware]=400
                          [firmware-sample]=100 [static]=400 [static-arm64]=400 [long]=0 [sanitize]=900)
declare -A test_seconds=([gates]=100 [sources]=1500 [quick]=60 [unit]=60 [odr]=0 [test]=800 [asan]=120 [firmware]=180
                         [firmware-sample]=100 [static]=0 [static-arm64]=0 [long]=3000 [sanitize]=1250)

build_of() {
  case $1 in
    gates | sources | quick | long) echo build/test ;;
    unit) echo build/asan ;;
    *) echo "build/$1" ;;
  esac
}

# expect PRESET: sets `tests` to the seconds that its tests took in the last run, if there was one, and `compile` to those of its
# build: what exists is built faster, but how much has changed is known only to ninja.
expect() {
  local build last
  build=$(build_of "$1")
  tests=${test_seconds[$1]} compile=${build_seconds[$1]}
  for last in "$build/times-$1.xml.last" "$build/times-$1.xml"; do
    if [ -f "$last" ]; then tests=$(sed -nE '1,9 s/^\ttime="([0-9]+).*/\1/p' "$last"); fi
  done
  if [ -f "$build/.ninja_log" ]; then compile=$((compile / 10)); fi
}

# steps PRESET: those of its workflow. Many tests of the release build wait, for frames, pages or virtual machines: meanwhile
# the programs of the later gears are built, which takes what other programs leave. What is not built then, the gear builds.
steps() {
  local status=0 builder
  if [ "$1" != test ] || [ ${#ahead[@]} -eq 0 ]; then cmake --workflow --preset "$1"; return; fi
  cmake --preset test && cmake --build --preset test || return
  # The kernel shares processors between sessions first: without the lowest priority there, the tests would get a half.
  chrt --idle 0 setsid bash -c '
    echo 19 >/proc/self/autogroup || true
    for gear; do cmake --preset "$gear" && cmake --build --preset "$gear"; done' ahead "${ahead[@]}" >build/ahead.log 2>&1 &
  builder=$!
  trap 'kill -- "-$builder" 2>/dev/null || true' EXIT
  ctest --preset test || status=$?
  kill -- "-$builder" 2>/dev/null || true
  wait "$builder" || true
  return $status
}

# run PRESET: a workflow preset and the times of its tests.
run() {
  local status=0 times tests compile
  times=$(build_of "$1")/times-$1.xml
  expect "$1"
  if [ -f "$times" ]; then mv "$times" "$times.last"; fi
  echo "== $1"
  steps "$1" 2>&1 | .ci/progress "$1" "$compile" "$tests" "$times.last" || status=$?
  .ci/test-times "$times"
  return $status
}

# parts GEAR: its presets.
parts() {
  case $1 in
    quick) echo gates quick unit ;;
    firmware) echo firmware-sample ;;
    long) echo static static-arm64 odr long firmware sanitize ;;
    *) echo "$1" ;;
  esac
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

ahead=()
if [[ " ${gears[*]} " == *" test "* ]]; then
  for gear in "${gears[@]}"; do
    case $gear in asan | firmware) ahead+=("$(parts "$gear")") ;; esac
  done
fi

total=0
for gear in "${gears[@]}"; do
  for part in $(parts "$gear"); do
    expect "$part"
    total=$((total + compile + tests))
  done
done
echo "${gears[*]}: about $(((total + 59) / 60)) min on two processors; the first builds take longer than later ones"

purpose=test
[[ " ${gears[*]} " != *" long "* ]] || purpose=release
.ci/install-packages "$purpose"
for gear in "${gears[@]}"; do
  for part in $(parts "$gear"); do run "$part"; done
done
