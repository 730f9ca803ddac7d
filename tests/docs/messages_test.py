#!/usr/bin/env python3
"""The messages and abort codes of docs/troubleshooting.md are those of the sources.

    messages_test.py SOURCE_DIR
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
# Messages of the operating system, the compiler, the linker and CMake.
FOREIGN = {"No such device", "Network is down", "Permission denied", "Connection refused", "multiple definition",
           "cstdint: No such file or directory", 'unable to find a build program corresponding to "Ninja"'}
FOLDERS = ("cli", "bus", "generator", "cmake", "runtime")
MESSAGE_ROW = re.compile(r"^\| `([^`]+)`", re.MULTILINE)
ABORT_ROW = re.compile(r"^\| ([0-9A-F]{4}) ([0-9A-F]{4})h, ([^|]+) \|", re.MULTILINE)


def main() -> int:
    text = (SOURCE_DIR / "docs/troubleshooting.md").read_text(encoding="utf-8")
    sources = [path.read_text(encoding="utf-8") for folder in FOLDERS for path in sorted((SOURCE_DIR / folder).rglob("*"))
               if path.suffix in (".hpp", ".cpp", ".cmake", ".in")]
    # Adjacent literals are one text.
    joined = re.sub(r'"\s*\n\s*"', "", "\n".join(sources))
    messages = [one for one in MESSAGE_ROW.findall(text) if one not in FOREIGN]
    problems = [f"no source has the message: {one}" for one in messages if one not in joined]
    codes = ABORT_ROW.findall(text)
    for high, low, meaning in codes:
        if not re.search(rf"0x{high}'?{low}", joined, re.IGNORECASE) or meaning not in joined:
            problems.append(f"the sources do not have abort code {high} {low}h, {meaning}")
    print("\n".join(problems))
    print(f"{len(messages)} messages, {len(codes)} abort codes, {len(problems)} problems")
    return 1 if problems or len(messages) < 10 or len(codes) < 5 else 0


if __name__ == "__main__":
    sys.exit(main())
