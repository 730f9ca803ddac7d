#!/usr/bin/env python3
"""Runs several tests in one virtual machine and prints their times: starting a machine takes longer than most of the tests.

    in_order.py COMMAND [ARGUMENT...] [-- COMMAND [ARGUMENT...]]...
"""

from __future__ import annotations

import subprocess
import sys
import time
from itertools import groupby
from pathlib import Path


def main() -> int:
    commands = [list(words) for separator, words in groupby(sys.argv[1:], lambda word: word == "--") if not separator]
    failed = 0
    for command in commands:
        begin = time.monotonic()
        ended = subprocess.run(command, check=False).returncode
        print(f"{Path(command[0]).name}: {'ok' if ended == 0 else f'ended with {ended}'}, {time.monotonic() - begin:.1f} s",
              flush=True)
        failed += ended != 0
    return 1 if failed or not commands else 0


if __name__ == "__main__":
    sys.exit(main())
