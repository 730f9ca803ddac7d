#!/usr/bin/env python3
"""Measures edsc decode on a log of a million frames, compared with a program that only reads the lines and writes them back.

    decode.py EDSC LOG_FLOOR [FRAMES]

The log is that of a machine: an axis with SYNC, two PDOs and a heartbeat, and an occasional SDO transfer or EMCY. Output goes
to /dev/null; the result is the shortest of five runs. Instructions are counted by callgrind (package valgrind) as the
difference of two logs, which excludes the start and the EDS.
"""

from __future__ import annotations

import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE_DIR = Path(__file__).resolve().parent.parent
AXIS = SOURCE_DIR / "tests/bus/decode/axis.dcf"
RUNS = 5
SDO = ("606#4008100000000000", "586#4108100011000000", "606#6000000000000000", "586#0061786973206F66", "606#7000000000000000",
       "586#1020746865207465", "606#6000000000000000", "586#0973747300000000", "606#2B40600006000000", "586#6040600000000000")


def make_log(path: Path, frames: int) -> None:
    microseconds, count, cycle = 1_436_509_052_000_000, 0, 0
    with path.open("w") as log:
        while count < frames:
            position = (cycle * 37 % 2**31).to_bytes(4, "little").hex().upper()
            wanted = ["080#", f"186#3702{position}", "206#0F0000B80B"]
            if cycle % 10 == 0:
                wanted += ["706#05", SDO[cycle // 10 % len(SDO)]]
            if cycle % 1000 == 0:
                wanted.append("086#1186210100000000")
            for number, frame in enumerate(wanted):
                time = microseconds + number * 120
                log.write(f"({time // 1_000_000}.{time % 1_000_000:06}) can0 {frame}\n")
            count += len(wanted)
            cycle += 1
            microseconds += 1000


def seconds(command: list[str], log: Path) -> float:
    """The minimum CPU time of several runs."""
    best = float("inf")
    for _ in range(RUNS):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with log.open("rb") as file:
            subprocess.run(command, stdin=file, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    return best


def instructions(command: list[str], log: Path) -> int:
    with log.open("rb") as file:
        result = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command], stdin=file,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=True)
    return int(re.search(r"refs:\s+([\d,]+)", result.stderr)[1].replace(",", ""))


def main() -> int:
    edsc, floor = sys.argv[1:3]
    frames = int(sys.argv[3]) if len(sys.argv) > 3 else 1_000_000
    commands = {
        "floor": [floor],
        "text": [edsc, "decode", "--node", str(AXIS), "-"],
        "json": [edsc, "decode", "--node", str(AXIS), "--format", "json", "-"],
    }
    with tempfile.TemporaryDirectory() as folder:
        log, short, shorter = (Path(folder) / name for name in ("long.log", "short.log", "shorter.log"))
        make_log(log, frames)
        make_log(short, 11_000)
        make_log(shorter, 1_000)
        lines = {path: len(path.read_text().splitlines()) for path in (log, short, shorter)}
        print(f"{lines[log]} frames, {log.stat().st_size / 1e6:.1f} MB")
        floor_seconds = None
        for name, command in commands.items():
            time = seconds(command, log)
            floor_seconds = floor_seconds or time
            text = f"{name:<6} {time:6.2f} s  {time / floor_seconds:4.1f} x the floor"
            if shutil.which("valgrind"):
                count = (instructions(command, short) - instructions(command, shorter)) / (lines[short] - lines[shorter])
                text += f"  {count:6.0f} instructions a frame"
            print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
