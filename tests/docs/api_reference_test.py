#!/usr/bin/env python3
"""The comments of the runtime's headers make an API reference without a warning of Doxygen.

    api_reference_test.py SOURCE_DIR
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
# Classes that an application uses: their pages must exist.
PAGES = ("classcanopen_1_1Node", "classcanopen_1_1Master", "classcanopen_1_1Mailbox", "structcanopen_1_1PdoLayout",
         "classcanopen_1_1cia402_1_1DriveNode")


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    if shutil.which("doxygen") is None:
        print("skipped: doxygen is not installed")
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        settings = (source / "docs/api.doxygen").read_text(encoding="utf-8") + f"OUTPUT_DIRECTORY = {scratch}\n"
        ran = subprocess.run(["doxygen", "-"], input=settings, cwd=source, capture_output=True, text=True)
        print(ran.stdout + ran.stderr, end="")
        missing = [page for page in PAGES if not (Path(scratch) / "html" / f"{page}.html").exists()]
    if missing:
        print("no page of " + ", ".join(missing))
    return 1 if ran.returncode != 0 or ran.stderr or missing else 0


if __name__ == "__main__":
    sys.exit(main())
