#!/bin/sh
# Accepts a device in continuous integration and keeps all reports.
#
#     accept.sh FOLDER BUS NODE EDS [options of edsc accept]
#
# Exit codes: 0 accepted, 1 not accepted, 2 wrong usage or no bus (no report), 3 the test is not complete.
set -u
reports=$1
shift
mkdir -p "$reports"
rm -f "$reports/accept.json"
edsc accept "$@" --quiet --junit "$reports/accept.xml" --html "$reports/accept.html" --json "$reports/accept.json" \
  --log "$reports/accept.log"
code=$?
[ "$code" -eq 1 ] || exit "$code"
early=$(python3 -c 'import json, sys
report = json.load(open(sys.argv[1]))
print(report["comparison"]["ended_early"] or report["conform"]["ended_early"] or "")' "$reports/accept.json")
[ -z "$early" ] && exit 1
echo "the test is not complete: $early" >&2
exit 3
