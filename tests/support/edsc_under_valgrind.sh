#!/bin/sh
# edsc of the release build under valgrind, which ends it with exit code 99 if it finds a fault.
exec valgrind --quiet --error-exitcode=99 "$(dirname "$0")/../../build/test/generator/edsc" "$@"
