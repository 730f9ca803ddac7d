#!/usr/bin/env python3
"""docs/footprint.md is the output of bench/footprint/measure.py, except for the figures, which depend on the compiler.

    footprint_test.py SOURCE_DIR EDSC [--tables]

Prints the page; with --tables only its tables of whole devices and whole frames. Flash and RAM of a whole device may exceed the page
by 5 %.
"""

from __future__ import annotations

import difflib
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, SKIPPED, those_installed  # noqa: E402

FIGURE = re.compile(r"(?<=\| )[+-]?\d+(?:\.\d+)?(?: %)?(?= \|)")
WHOLE_DEVICE = re.compile(r"^\| ((?:flash|RAM), [^|]+) \| (\d+) \|", re.MULTILINE)
MOST_GROWTH = 1.05


def main() -> int:
    source_dir, edsc = (Path(argument).resolve() for argument in sys.argv[1:3])
    if not those_installed([ARM_GCC]) or shutil.which("qemu-system-arm") is None:
        return SKIPPED
    written = (source_dir / "docs/footprint.md").read_text(encoding="utf-8")
    only_tables = "--tables" in sys.argv
    printed = subprocess.run([sys.executable, source_dir / "bench/footprint/measure.py", edsc, source_dir / "runtime/include",
                              "--tables" if only_tables else "--page"], check=True, capture_output=True, text=True,
                             timeout=3400).stdout
    print(printed)
    if only_tables:
        written = "\n\n".join(part for part in written.split("\n\n") if part.startswith(("| bytes | edsc", "| instructions | M4"))) + "\n"
    problems = list(difflib.unified_diff(FIGURE.sub("#", written).splitlines(), FIGURE.sub("#", printed).splitlines(),
                                         "docs/footprint.md", "printed", lineterm="", n=0))
    said = dict(WHOLE_DEVICE.findall(written))
    for what, figure in WHOLE_DEVICE.findall(printed):
        if int(figure) > int(said.get(what, 0)) * MOST_GROWTH:
            problems.append(f"{what}: {figure} bytes; docs/footprint.md has {said.get(what)}")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
