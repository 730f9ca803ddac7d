#!/usr/bin/env python3
"""Prints the flash, RAM and stack of the images that the preset `firmware` has built and whose tests have recorded the stack.

    images.py DIR [--check]

DIR is build/firmware/tests/firmware. Prints docs/images.md; `--check` compares its text and figures with the present page.
Flash and RAM of another compiler may differ by 3 %. The stack, which the tests limit, is larger when many frames come at once.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/images.md"
BOARDS = {"microbit": "Cortex-M0+", "mps2-an385": "Cortex-M3", "mps2-an386": "Cortex-M4"}
TOLERANCE, OF_THE_STACK = 0.03, 0.15
REPORT = re.compile(r"(.+)\.elf: (\d+) bytes of flash.*?, (\d+) bytes of RAM")
HEAD = """# Images of the reference devices

`bench/footprint/images.py build/firmware/tests/firmware` prints this page, after `cmake --workflow --preset firmware`.

Each image is all of a device's firmware: start-up, the board's drivers, the C library, SLCAN on a serial line, storage in flash
where the device stores, LSS where its node-ID comes by it, and the node, as `edsc_add_firmware` builds it (`-Os`, `-flto`,
arm-none-eabi-g++ 12). RAM is `.data` and `.bss`.
Stack use was measured by filling the stack with a pattern and counting the bytes overwritten during boot, access to all entries
and PDOs, and a store. Bytes:

"""


def figures(folder: Path) -> dict[tuple[str, str], tuple[str, str, str]]:
    """Flash, RAM and stack by EDS and board."""
    found = {}
    for report in sorted(folder.glob("*.report.txt")):
        name, flash, ram = REPORT.match(report.read_text(encoding="utf-8")).groups()
        sheet, board = name.rsplit("_", 1)
        stack = folder / f"{name}.stack"
        if board not in BOARDS:
            continue  # another image than that of examples/firmware
        found[sheet, board] = flash, ram, stack.read_text(encoding="utf-8").strip() if stack.exists() else "-"
    return found


def page(folder: Path) -> str:
    found = figures(folder)
    sheets = sorted({sheet for sheet, _ in found}, key=lambda sheet: (sheet.startswith("bench"), len(sheet), sheet))
    heads = " | ".join(f"{core}: flash | RAM | stack" for core in BOARDS.values())
    lines = [f"| EDS | {heads} |", "| --- |" + " --: |" * 3 * len(BOARDS)]
    for sheet in sheets:
        lines.append(f"| `{sheet}` | " + " | ".join(" | ".join(found.get((sheet, board), ("-",) * 3)) for board in BOARDS) + " |")
    return HEAD + "\n".join(lines) + "\n"


def differ(column: int, written: str, printed: str) -> bool:
    """Whether two cells differ. A cell without a measurement is not compared."""
    if written.isdecimal() and printed.isdecimal():
        is_stack = column > 0 and column % 3 == 0
        return abs(int(written) - int(printed)) > (OF_THE_STACK if is_stack else TOLERANCE) * int(printed)
    return written != printed and not (written.isdecimal() and printed == "-")


def compare(written: list[str], printed: list[str]) -> list[str]:
    found = [f"docs/images.md has {len(written)} lines, not {len(printed)}"] if len(written) != len(printed) else []
    for number, (before, now) in enumerate(zip(written, printed), 1):
        cells = [line.split(" | ") for line in (before.strip("| "), now.strip("| "))]
        if len(cells[0]) != len(cells[1]) or any(map(differ, range(len(cells[0])), *cells)):
            found.append(f"docs/images.md:{number}: {before}\n  the images: {now}")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    printed = page(arguments.folder)
    if not arguments.check:
        print(printed, end="")
        return 0
    differences = compare(PAGE.read_text(encoding="utf-8").splitlines(), printed.splitlines())
    print("\n".join(differences))
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
