#!/usr/bin/env python3
"""Measures how much longer edsc needs for an overlay than for the EDS that it results in.

    overlays.py EDSC [--runs N] [--before EDSC]

`edsc check` of eds1000 and eds5000 (sheets.py), and of an overlay of each with values, a range, added and removed objects:
CPU time (best of the runs) and the number of instructions, which does not depend on the load of the machine (valgrind's
callgrind). `--before` also measures another edsc with the plain EDS.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

import sheets
from generation import instructions, run

CHANGES = """[Overlay]
Version=1
Base={base}
; a value
[6502]
ParameterName=drive_6502 => Supported drive modes
; a missing limit
[1017]
HighLimit= => 1000
; a range
[2400-5FFF]
DefaultValue=0x9 => 0x8
; an added object
[2345]
ParameterName=Added
ObjectType=0x7
DataType=0x0007
AccessType=rw
; a removed object
[2404]
Remove=1
"""


def overlay_of(path: Path) -> Path:
    overlay = path.with_suffix(".overlay")
    overlay.write_text(CHANGES.format(base=path.name))
    return overlay


def measure(edsc: str, path: Path, runs: int) -> tuple[float, str]:
    command = [edsc, "check", str(path)]
    return min(run(command).cpu for _ in range(runs)), instructions(command)


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures edsc with overlays.")
    parser.add_argument("edsc")
    parser.add_argument("--runs", type=int, default=9)
    parser.add_argument("--before", default="")
    settings = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for name in ("eds1000", "eds5000"):
            plain = Path(sheets.write(name, Path(folder)))
            overlay = overlay_of(plain)
            applied = plain.with_name(f"{name}_applied.eds")
            subprocess.run([settings.edsc, "overlay", "apply", overlay, "-o", applied], check=True)
            rows = [("EDS", settings.edsc, applied), ("overlay", settings.edsc, overlay)]
            if settings.before:
                rows.insert(0, ("EDS, before", settings.before, applied))
            for title, edsc, path in rows:
                seconds, count = measure(edsc, path, settings.runs)
                print(f"{name:10} {title:12} {1000 * seconds:8.1f} ms CPU  {count:>8} instructions")


if __name__ == "__main__":
    main()
