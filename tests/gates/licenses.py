#!/usr/bin/env python3
"""Each file has a license, and LICENSES has its text: `reuse lint` (https://reuse.software) accepts the project.

    licenses.py SOURCE_DIR

`.reuse/dep5` has the license of all files that do not state another one. Exit code 77: skipped.
"""

from __future__ import annotations

import shutil
import subprocess
import sys


def main() -> int:
    if shutil.which("reuse") is None:
        print("skipped: reuse is not installed")
        return 77
    result = subprocess.run(["reuse", "--root", sys.argv[1], "lint"], capture_output=True, text=True)
    if result.returncode != 0:
        print(result.stdout + result.stderr)
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
