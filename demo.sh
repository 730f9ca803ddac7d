#!/usr/bin/env bash
# Builds the demo and runs it: a wrong EDS is rejected, eight devices are generated, five of them run with a master on a simulated
# bus, and edsc documents the devices and plots the log. `./demo.sh --log FILE` also writes the frames to FILE.
# With EDSC_DEMO_BUILD=FOLDER nothing is built: the programs are those of that build.
set -euo pipefail
if [ $# -ne 0 ] && { [ $# -ne 2 ] || [ "$1" != --log ]; }; then
  echo "usage: demo.sh [--log FILE]" >&2
  exit 2
fi
log_file=${2:+$(realpath -m "$2")}
cd "$(dirname "$0")"

build=${EDSC_DEMO_BUILD:-build/demo}
shows=build/demo/shows # what the demo writes
# Seconds that the build takes from nothing, on two processors.
expected=130
if [ -x $build/examples/demo/demo ]; then
  echo "This takes a few seconds if nothing has changed since the last run."
  expected=10
else
  echo "This takes about $((expected / 60 + 1)) minutes, nearly all for the first build (in $build); later runs take a few seconds."
fi
.ci/install-packages build
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if [ -z "${EDSC_DEMO_BUILD:-}" ]; then
  cmake --workflow --preset demo 2>&1 | .ci/progress --log "$log" "Building" $expected 0 || { cat "$log" >&2; exit 1; }
fi
generator=$build/cli/edsc_generator
[ -x $generator ] || generator=$build/generator/edsc
mkdir -p $shows
edsc() { $generator "$@"; }

echo
echo "== 1. The EDS of a pump, in which RPDO 1 maps the pressure, a value that is read only"
sed '/^\[1600sub1\]/,/^$/ s/^DefaultValue=.*/DefaultValue=0x20010010/' examples/first_device/pump.eds >$shows/pump.eds
echo "\$ edsc check $shows/pump.eds"
if edsc check $shows/pump.eds; then exit 1; fi

echo
echo "== 2. The same mistake in C++, with the headers of the correct EDS: it does not compile"
edsc generate examples/first_device/pump.eds -o $shows/include
cat >$shows/wrong.cpp <<'CPP'
#include <pump/device.hpp>

using WrongMapping = canopen::Rpdo<pump::od::pressure>;
constexpr auto entries = WrongMapping::entries;
CPP
cat $shows/wrong.cpp
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' $build/CMakeCache.txt)
if "$compiler" -std=c++20 -fsyntax-only -I$shows/include -Iruntime/include $shows/wrong.cpp >$shows/wrong.txt 2>&1; then
  echo "demo.sh: the wrong mapping compiles" >&2
  exit 1
fi
echo "\$ $(basename "$compiler") -std=c++20 $shows/wrong.cpp        (the rest of its output is in $shows/wrong.txt)"
grep -E "RpdoEntry<.*pump::od::pressure>’:|RpdoEntry<.*pressure>' requested|error:" $shows/wrong.txt

echo
echo "== 3. Eight devices from their EDS files; five of them and a master on a simulated bus"
$build/examples/demo/demo --log $shows/demo.log
if [ -n "$log_file" ]; then cp $shows/demo.log "$log_file"; fi

echo
echo "== 4. Pages of the devices, and a plot of the log"
for eds in eds/*.eds; do edsc document "$eds" -o "$shows/$(basename "$eds" .eds).html"; done
edsc plot $shows/demo.log 5/position_values_for_multi_sensor_devices_1 3/6041h 2/6041h --node 5=eds/rk5c.eds --node 3=eds/cpc-tc1.eds \
  --node 2=eds/cpd.eds --title "Demo: a sensor and two drives" -o $shows/demo.svg

cat <<END

What this has shown:
  - \`edsc check\` names the line of a wrong PDO mapping, and the compiler names the object.
  - Dictionary, PDOs and services of eight devices were generated; five of them booted, were configured and exchanged PDOs.
  - edsc knows the names and units of every frame, and draws them.

Open in a browser:
  $PWD/$shows/cpc-tc1.html   a servo drive; the pages of the other devices are beside it
  $PWD/$shows/demo.svg       position of the sensor, statusword of the drives

Next:
  docs/tutorial.md                            from an EDS to a device on a bus and on a board, in half an hour
  cmake --build $build --target nodes     the program edsc with all commands, in $build/generator, and devices to run on a bus
  $build/generator/edsc help              its commands
END
if [ ! -s $build/generator/uplot/uplot.js ]; then
  echo "This build has no plots in \`edsc monitor --web\`: cmake -B $build -DEDSC_PLOTS=ON, with access to the npm registry, adds them."
fi
