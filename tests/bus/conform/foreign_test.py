#!/usr/bin/env python3
"""edsc conform with slaves without edsc's code: it reports their gaps, and nothing else.

    foreign_test.py SOURCE_DIR EDSC [--node-canopen WORK_DIR]

foreign_slave.py passes all cases without gaps, and with all gaps fails those of `GAPS`. npm's canopen fails those of
`NODE_CANOPEN`, with the version of the lock file; without --node-canopen, or if npm cannot install it, it is skipped with a
message.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "masters")]
from bench import NODE_ID, TRIES, Bench, is_late, patterns, run_problems  # noqa: E402
from foreign_slave import GAPS as ALL_GAPS  # noqa: E402
from masters_test import Skipped, install_node_canopen  # noqa: E402

SHEET = HERE / "foreign_slave.eds"

# By case: the gap, the expected result and the actual result.
GAPS = {
    "2.3": ("writable", "write of 1000h:00: an abort with 0601 0002h", "write of 1000h:00: done"),
    "2.5": ("abort-code", "read of 1000h:01: an abort with 0609 0011h", "read of 1000h:01: 0602 0000h"),
    "2.8": ("length", "4 bytes to 1017h:00 Producer heartbeat time: an abort with 0607 0010h", "done"),
    "2.9": ("length", "1 byte to 1017h:00 Producer heartbeat time: an abort with 0607 0010h", "done"),
    "2.108": ("length", "4 bytes to 1017h:00 with an indicated size of 4: an abort with 0607 0010h", "the value 20 00"),
    "2.15": ("toggle-bit", "a first segment with toggle bit 1: an abort with 0503 0000h", "the value 20 00"),
    "2.17": ("toggle-bit", "requested with toggle bit 1: an abort with 0503 0000h", "the value 00"),
    "4.3": ("writable", "each write of a read-only entry is refused", "1000h:00 Device type: written"),
    "4.5": ("abort-code", "each sub-index FFh", "1018h:FF Identity object: refused by the device: 0602 0000h"),
    "7.102": ("heartbeat", "20 heartbeats in 2000 ms", "1"),
    "7.109": ("heartbeat", "more than 40 heartbeats in 42 periods", "2"),
    "9.1": ("boot-up", "a boot-up message", "none"),
    "10.1": ("boot-up", "a boot-up message", "none"),
}
NODE_CANOPEN = {
    "2.5": ("an upload of a VAR ignores the sub-index", "0609 0011h", "the value 00 00 00 00"),
    "2.8": ("a download does not compare the length with the type", "0607 0010h", "done"),
    "2.9": ("a number that is too short ends the program", "0607 0010h", "no answer"),
    "2.22": ("a segment that is asked for again ends the program", "segment 1", "no answer"),
    "2.23": ("the same", "segment 1", "no answer"),
    "2.26": ("a block size above 127 is not refused", "0504 0002h", "the value C6 00 10 00 04 00 00 00"),
    "2.27": ("a sequence number above the block size ends the program", "0504 0003h", "no answer"),
    "2.101": ("a segment without a transfer is answered", "0504 0001h", "the value 0F 00"),
    "2.102": ("a segment without a transfer is not refused", "0504 0001h", "no answer"),
    "2.103": ("the same of a block", "0504 0001h", "no answer"),
    "2.104": ("an abort does not end a transfer", "0504 0001h", "the value 00 61"),
    "2.105": ("a request with 5 bytes is executed", "0 (0h)", "232 (E8h)"),
    "2.108": ("a download does not compare the length with the type", "0607 0010h", "the value 20 00"),
    "9.1": ("no boot-up message", "a boot-up message", "none"),
    "9.2": ("no boot-up message", "a boot-up message", "none"),
    "10.1": ("no boot-up message", "a boot-up message", "none"),
}
assert {gap for gap, _, _ in GAPS.values()} == set(ALL_GAPS)

Expected = dict[str, tuple[str, str, str]]


def problems_of(report: dict, expected: Expected, among: set[str] | None) -> dict[str, str]:
    """Returns the unexpected result of each case. `among`: the cases that have run; None: all."""
    problems = {}
    for case in report["cases"]:
        verdict, wanted = case["verdict"], expected.get(case["id"])
        if verdict == "failed":
            text = f"expected {case['expected']}; got {case['got']}"
            if wanted is None:
                problems[case["id"]] = f"fails: {text}"
            elif wanted[1] not in case["expected"] or not case["got"] or wanted[2] not in case["got"]:
                problems[case["id"]] = f"fails otherwise: {text}"
        elif is_late(case):
            print(f"case {case['id']}: {case['reason']}")
        elif wanted is not None:
            problems[case["id"]] = f"{verdict}, which does not name the gap: {wanted[0]}"
        elif verdict == "inconclusive":
            problems[case["id"]] = f"inconclusive: {case['reason']}"
    seen = {case["id"] for case in report["cases"]}
    missing = set(expected) - seen if among is None else set()
    return problems | {case: "did not run" for case in missing}


def test_slave(edsc: Path, folder: Path, program: list[object], arguments: list[object], expected: Expected,
               level: str = "all") -> list[str]:
    """Returns the problems."""
    bench = Bench(edsc, folder)
    try:
        bench.start_node(program, [NODE_ID, *arguments], "started")
        report = bench.conform(SHEET, folder / "report.json", level=level)
        counts = ", ".join(f"{count} {name}" for name, count in report["verdicts"].items() if count)
        print(f"{folder.name}: {counts}")
        found = run_problems(report)
        problems = problems_of(report, expected, None)
        for again in range(1, TRIES):
            if not problems or any(text.startswith("fails") for text in problems.values()):
                break
            report = bench.conform(SHEET, folder / f"report-{again}.json", *patterns(problems), level=level)
            found += run_problems(report)
            problems = problems_of(report, expected, set(problems))
        return [f"{folder.name}: {text}" for text in [*found, *(f"{case} {text}" for case, text in problems.items())]]
    finally:
        bench.close()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--node-canopen", type=Path)
    arguments = parser.parse_args()
    began = time.monotonic()
    folder = Path(tempfile.mkdtemp(prefix="edsc-conform-"))
    edsc = arguments.edsc.resolve()
    slave = [sys.executable, HERE / "foreign_slave.py"]
    tests = [
        (edsc, folder / "without gaps", slave, [], {}),
        (edsc, folder / "with gaps", slave, [*ALL_GAPS], GAPS),
    ]
    if arguments.node_canopen:
        try:
            program = install_node_canopen(arguments.node_canopen).with_name("slave.js")
            tests.append((edsc, folder / "npm's canopen", ["node", program], [SHEET], NODE_CANOPEN))
        except Skipped as reason:
            print(f"skipped: npm's canopen: {reason}")
    try:
        with ThreadPoolExecutor(len(tests)) as pool:
            problems = [text for found in pool.map(lambda test: test_slave(*test), tests) for text in found]
    finally:
        shutil.rmtree(folder)
    print("\n".join(problems), end="\n" if problems else "")
    print(f"{time.monotonic() - began:.1f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
