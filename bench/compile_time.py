#!/usr/bin/env python3
"""Measures edsc on an EDS and a compiler on the generated code, with the figures of other tools.

    compile_time.py EDSC RUNTIME_INCLUDE_DIR

Prints for each EDS of sheets.py the wall time and the peak memory of edsc, and of g++ and clang++ for the device header
alone, at -O2 with the compilers' default limits for constant expressions. Best of three runs.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import sheets

COMPILERS = ["g++", "clang++"]
RUNS = 3


def measure(command: list[str]) -> tuple[float, float]:
    """Seconds and MB of one run."""
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {child.returncode}")
    return time.monotonic() - start, usage.ru_maxrss / 1024


def best(command: list[str]) -> str:
    seconds, memory = min(measure(command) for _ in range(RUNS))
    return f"{seconds:6.2f} s {memory:5.0f} MB"


def main() -> None:
    edsc, runtime = sys.argv[1], sys.argv[2]
    print(f"{'':12}{'edsc':>17}" + "".join(f"{compiler + ' -O2':>19}" for compiler in COMPILERS))
    with tempfile.TemporaryDirectory() as folder:
        for sheet in sheets.SHEETS:
            path = sheets.write(sheet, Path(folder))
            row = best([edsc, "generate", str(path), "-o", folder, "--name", "device"])
            source = Path(folder) / "device.cpp"
            source.write_text("#include <device/device.hpp>\n", encoding="utf-8")
            for compiler in COMPILERS:
                row += "  " + best([compiler, "-std=c++20", "-O2", "-c", f"-I{folder}", f"-I{runtime}", str(source),
                                    "-o", os.devnull])
            print(f"{sheet:12} {row}", flush=True)
    print("\nOthers, on such a machine: generating eds1000 / eds5000: lely dcf2c 0.02 / 0.11 s, objdictgen 0.43 / 2.9 s,")
    print("modm-canopen 0.12 / 0.54 s; compiling a modm-canopen device of 1125 entries: 6.4 s, 845 MB.")


if __name__ == "__main__":
    main()
