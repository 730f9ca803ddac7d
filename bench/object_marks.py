#!/usr/bin/env python3
"""Times of `edsc object` for an EDS of 500 kB: median and 95th percentile of the whole process, and its CPU time.

    object_marks.py SOURCE_DIR EDSC [--runs N] [--check]

--check fails above the mark. The wall time has two fsync, of the new file and of its folder.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from lsp_marks import big_sheet, percentile

MARK = 100  # ms
COMMANDS = {
    "set": ("set", "{path}", "2900h", "DefaultValue={number}"),
    "add": ("add", "{path}", "5F00h", "Motor temperature", "INTEGER16", "ro", "--mappable"),
    "map": ("map", "{path}", "tpdo", "1", "5F00h", "--cob-id", "0x1F0"),
    "unmap": ("map", "{path}", "tpdo", "1", "none"),
    "rename": ("rename", "{path}", "5F00h", "5F01h"),
    "remove": ("remove", "{path}", "5F01h"),
}


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--runs", type=int, default=30)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    times: dict[str, list[float]] = {name: [] for name in COMMANDS}
    cpu: dict[str, list[float]] = {name: [] for name in COMMANDS}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "big.eds"
        path.write_text(big_sheet(arguments.source / "eds/rk5c.eds"), encoding="utf-8")
        for number in range(arguments.runs):
            for name, words in COMMANDS.items():
                command = [arguments.edsc.resolve(), "object", *(word.format(path=path, number=number) for word in words)]
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                start = time.perf_counter()
                subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
                times[name].append((time.perf_counter() - start) * 1000)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                cpu[name].append((after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) * 1000)
    print(f"{'ms':<8} median   p95   CPU, median   mark of p95: {MARK}")
    for name, values in times.items():
        print(f"{name:<8} {statistics.median(values):6.0f} {percentile(values):5.0f} {statistics.median(cpu[name]):13.0f}")
    return int(arguments.check and any(percentile(values) > MARK for values in times.values()))


if __name__ == "__main__":
    sys.exit(main())
