#!/usr/bin/env python3
"""Measures the time and memory of `edsc generate`, including its checks, with the figures of other tools.

    generation.py EDSC [--runs N]

For eds1000, eds5000 and EDS files with 5,000, 10,000 and 20,000 RECORDs of 5 sub-indices (make_eds.py): wall and CPU time (best
of five runs), memory, EDS bytes per second of CPU time, and the number of instructions, which does not depend on the load of
the machine (valgrind's callgrind; omitted if it is not installed).
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import sheets

HERE = Path(__file__).parent

# Seconds of other tools, measured on a machine of the same kind (2 cores, gcc 12.2 -O2).
PEERS = {
    "lely dcf2c": {"eds1000": 0.022, "eds5000": 0.108},
    "objdictgen": {"eds1000": 0.43, "eds5000": 2.9},
    "modm-canopen": {"eds1000": 0.12, "eds5000": 0.54},
}


@dataclass
class Run:
    wall: float
    cpu: float
    megabytes: float


def run(command: list[str]) -> Run:
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {child.returncode}")
    return Run(time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def instructions(command: list[str]) -> str:
    """The number of instructions in millions."""
    if shutil.which("valgrind") is None:
        return "-"
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command],
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    return f"{int(found[1]) / 1e6:.0f} M" if found else "-"


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures edsc for EDS files of growing size.")
    parser.add_argument("edsc")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    print(f"{'':12}{'MB':>7}{'wall s':>9}{'CPU s':>8}{'memory MB':>11}{'MB/s':>7}{'instructions':>14}   times the speed of")
    with tempfile.TemporaryDirectory() as folder:
        measured = {name: sheets.write(name, Path(folder)) for name in ("eds1000", "eds5000")}
        for objects in (5000, 10000, 20000):
            sheet = measured[f"{objects} x 5"] = Path(folder) / f"big{objects}.eds"
            with sheet.open("w") as file:  # in a separate process: the memory of this one counts for its children
                subprocess.run([sys.executable, HERE / "make_eds.py", str(objects), "--subs", "5"], stdout=file, check=True)
        for name, sheet in measured.items():
            def command(output: int) -> list[str]:
                return [arguments.edsc, "generate", str(sheet), "-o", f"{folder}/{output}", "--name", "device"]

            runs = [run(command(i)) for i in range(arguments.runs)]  # each writes new files
            wall, cpu = min(r.wall for r in runs), min(r.cpu for r in runs)
            size = sheet.stat().st_size / 1e6
            peers = ", ".join(f"{peer} {figures[name] / wall:.1f}" for peer, figures in PEERS.items() if name in figures)
            print(f"{name:12}{size:7.2f}{wall:9.3f}{cpu:8.3f}{max(r.megabytes for r in runs):11.0f}{size / cpu:7.0f}"
                  f"{instructions(command(arguments.runs)):>14}   {peers}", flush=True)
            for output in range(arguments.runs + 1):
                shutil.rmtree(f"{folder}/{output}", ignore_errors=True)


if __name__ == "__main__":
    main()
