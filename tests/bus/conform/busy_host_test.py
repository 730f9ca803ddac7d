#!/usr/bin/env python3
"""edsc conform with a pump whose pressure changes by itself, beside programs that keep the computer busy: no case fails.

    busy_host_test.py SOURCE_DIR EDSC PUMP [--runs N] [--parallel N] [--loops N] [--level LEVEL] [--case CASE]... [--keep FOLDER]

PUMP is the program of sensor_pump.cpp. A case may be inconclusive. The number of each verdict is printed.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from bench import Bench, end_with_parent, patterns  # noqa: E402


def run(arguments: argparse.Namespace, folder: Path, number: int) -> dict:
    bench = Bench(arguments.edsc.resolve(), folder / str(number))
    try:
        bench.start_node([arguments.pump], [], "started")
        sheet = arguments.source_dir / "examples" / "first_device" / "pump.eds"
        return bench.conform(sheet, bench.folder / "report.json", "--seed", number + 1, "--log", bench.folder / "log",
                             *patterns(arguments.case), level=arguments.level, timeout_ms=500)
    finally:
        bench.close()


def problems_of(report: dict) -> list[str]:
    problems = [f"{case['id']} failed: expected {case['expected']}; got {case['got']}"
                for case in report["cases"] if case["verdict"] == "failed"]
    problems += [f"not restored: {text}" for text in report["not_restored"]]
    return [*problems, report["ended_early"]] if report["ended_early"] else problems


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("pump", type=Path)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--parallel", type=int, default=1, help="runs at the same time")
    parser.add_argument("--loops", type=int, default=4, help="programs that keep a processor busy")
    parser.add_argument("--level", default="all")
    parser.add_argument("--case", action="append", default=[], metavar="CASE", help="2.5 or 3.*; may be given more than once")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep reports and logs here")
    arguments = parser.parse_args()
    began = time.monotonic()
    folder = arguments.keep or Path(tempfile.mkdtemp(prefix="edsc-conform-"))
    loops = [subprocess.Popen(["sh", "-c", "while :; do :; done"], preexec_fn=end_with_parent) for _ in range(arguments.loops)]
    verdicts: Counter = Counter()
    with_problems = 0
    try:
        with ThreadPoolExecutor(arguments.parallel) as pool:
            for number, report in enumerate(pool.map(lambda i: run(arguments, folder, i), range(arguments.runs))):
                problems = problems_of(report)
                with_problems += bool(problems)
                verdicts.update(report["verdicts"])
                inconclusive = ", ".join(case["id"] for case in report["cases"] if case["verdict"] == "inconclusive")
                print(f"run {number + 1}: maximum lag {report['max_lag_us'] // 1000} ms; inconclusive: {inconclusive or 'none'}",
                      *problems, sep="\n    ", flush=True)
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
        if not arguments.keep:
            shutil.rmtree(folder)
    counts = ", ".join(f"{count} {name}" for name, count in verdicts.items() if count)
    print(f"{arguments.runs} runs, {with_problems} with a problem; {counts}; {time.monotonic() - began:.1f} s")
    return 1 if with_problems else 0


if __name__ == "__main__":
    sys.exit(main())
