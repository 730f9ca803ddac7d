#!/usr/bin/env python3
"""edsc conform with the slaves of foreign/, each with one behaviour: what is not a fault fails no case and is named, and each fault
fails its cases and no other. foreign/behaviours.py has the table.

    foreign_behaviour_test.py SOURCE_DIR EDSC [--only NAME]... [--all-cases] [--keep FOLDER]

Without Node.js its slave is ignored, with a message. Each unexpected failure is an error, however busy the computer is. Another
unexpected result can be due to the computer: the case runs again, at most `TRIES` times.
"""

from __future__ import annotations

import argparse
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from bench import NODE_ID, TRIES, Bench, end_with_parent, is_late, patterns  # noqa: E402
from foreign.behaviours import BEHAVIOURS, NODE_JS, PYTHON, Behaviour  # noqa: E402

SLAVES = HERE / "foreign"
RUNS = 2  # of a behaviour with an unexpected result
FAILED = "failed"
SHEETS = {PYTHON: SLAVES / "device.eds", NODE_JS: HERE / "foreign_slave.eds"}
WITH_STIMULI = ("3.4", "3.7", "3.10", "3.13", "3.16", "3.19", "5.103", "5.106", "8.2", "8.6", "8.101", "8.102")
SIMULATED = ("5.104",)  # inconclusive in real time


class Run:
    """A slave on its own bus, and the conformance test of it."""

    def __init__(self, edsc: Path, folder: Path, behaviour: Behaviour, all_cases: bool) -> None:
        self.behaviour, self.folder = behaviour, folder
        self.only = () if all_cases else behaviour.only
        self.level = "hostile" if all_cases else behaviour.level
        self.sheet = SHEETS[behaviour.program]
        self.bench = Bench(edsc, folder)
        self.name = f"{behaviour.program} {behaviour.name}"

    def start(self) -> None:
        slave = SLAVES / self.behaviour.program
        if self.behaviour.program == PYTHON:
            self.bench.start_node([sys.executable, slave], [NODE_ID, self.behaviour.name], "started")
        else:
            self.bench.start_node(["node", slave], [NODE_ID, self.sheet, self.behaviour.name], "started")
        if self.behaviour.bridge:
            near = self.bench.address
            self.bench.address = self.bench.start_bus()
            bridge = subprocess.Popen([sys.executable, SLAVES / "bridge.py", near, self.bench.address], text=True,
                                      stdout=subprocess.PIPE, preexec_fn=end_with_parent)
            self.bench.processes.append(bridge)
            assert bridge.stdout.readline().strip() == "started"

    def conform(self, name: str, cases: tuple[str, ...]) -> dict:
        """Runs cases; empty: all."""
        command = f"echo $EDSC_STIMULUS > {shlex.quote(str(self.folder / 'lines'))}"
        stimuli = [option for case in WITH_STIMULI for option in ("--stimulus", f"{case}={command}")]
        options = [*stimuli, "--log", self.folder / f"{name}.log"]
        return self.bench.conform(self.sheet, self.folder / f"{name}.json", *options, *patterns(cases), level=self.level,
                                  timeout_ms=self.behaviour.timeout_ms)

    def problems(self) -> list[str]:
        """Returns the problems of the run and of its cases, after repetitions of the cases without the expected result. On a
        computer that remains too busy, a fault cannot be shown."""
        report = self.conform("report", self.only)
        counts = ", ".join(f"{count} {name}" for name, count in report["verdicts"].items() if count)
        found = problems_of_run(report, self.behaviour)
        cases = problems_of_cases(report, self.behaviour)
        print(f"{self.name}: {counts or report['ended_early']}" + "".join(f"; {case} {text}" for case, text in cases.items()))
        for again in range(1, TRIES):
            if not cases or found or has_failed(cases):
                break
            report = self.conform(f"report-{again}", tuple(cases))
            cases = {case: text for case, text in problems_of_cases(report, self.behaviour).items() if case in cases}
            print(f"{self.name}: repeated: {', '.join(cases) or 'as expected'}")
        late = {case["id"] for case in report["cases"] if is_late(case)}
        return [*found, *(f"{case} {text}" for case, text in cases.items() if case not in late)]


def has_failed(cases: dict[str, str]) -> bool:
    return any(text.startswith(FAILED) for text in cases.values())


def problems_of_run(report: dict, behaviour: Behaviour) -> list[str]:
    """Returns what is wrong with the run as a whole: its end, and what it does not name."""
    problems = []
    ended = report["ended_early"] or ""
    if bool(ended) != bool(behaviour.ended) or not re.search(behaviour.ended, ended):
        problems.append(f"ended early: {ended!r}; expected {behaviour.ended!r}")
    if not ended:
        problems += [f"not restored: {text}" for text in report["not_restored"]]
    texts = [text for case in report["cases"] for text in [case["reason"] or "", *case["warnings"]]]
    problems += [f"not named: {text}" for text in behaviour.named if not any(re.search(text, found) for found in texts)]
    if behaviour.causes and len(report["causes"]) != behaviour.causes:
        problems.append(f"{len(report['causes'])} causes instead of {behaviour.causes}")
    return problems


def problems_of_cases(report: dict, behaviour: Behaviour) -> dict[str, str]:
    """Returns the unexpected result of each case."""
    problems = {}
    for case in report["cases"]:
        verdict, failure = case["verdict"], behaviour.failed.get(case["id"])
        if verdict == "failed":
            text = f"{FAILED}: expected {case['expected']}; got {case['got']}"
            if failure is None or not re.search(failure.expected, case["expected"]) or not re.search(failure.got, case["got"]):
                problems[case["id"]] = text
        elif failure is not None:
            problems[case["id"]] = f"{verdict}: the fault is not reported: {case['reason']}"
        elif verdict == "inconclusive" and not is_expected(case, behaviour):
            problems[case["id"]] = f"inconclusive: {case['reason']}"
    return problems


def is_expected(case: dict, behaviour: Behaviour) -> bool:
    """Whether the case may be inconclusive for its reason."""
    allowed = [*behaviour.named, *behaviour.also, *([behaviour.ended] if behaviour.ended else [])]
    return is_late(case) or case["id"] in SIMULATED or any(re.search(text, case["reason"]) for text in allowed)


def test_behaviour(edsc: Path, folder: Path, behaviour: Behaviour, all_cases: bool) -> list[str]:
    """Returns the problems. A computer that stops for seconds can end a run or change a slave: it then runs again."""
    began = time.monotonic()
    problems: list[str] = []
    for attempt in range(RUNS):
        run = Run(edsc, folder / str(attempt), behaviour, all_cases)
        try:
            run.start()
            problems = run.problems()
        finally:
            run.bench.close()
        print(f"{run.name}: {time.monotonic() - began:.1f} s")
        if not problems or any(f" {FAILED}:" in text for text in problems):
            break
    return [f"{run.name}: {text}" for text in problems]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--only", action="append", metavar="NAME", help="a behaviour; may be given more than once")
    parser.add_argument("--all-cases", action="store_true", help="run all cases for each behaviour")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="keep reports and logs here")
    arguments = parser.parse_args()
    began = time.monotonic()
    rows = [row for row in BEHAVIOURS if not arguments.only or row.name in arguments.only]
    if shutil.which("node") is None:
        print("skipped: slave.js: there is no Node.js")
        rows = [row for row in rows if row.program != NODE_JS]
    folder = arguments.keep or Path(tempfile.mkdtemp(prefix="edsc-conform-"))
    edsc = arguments.edsc.resolve()
    try:
        with ThreadPoolExecutor(len(rows)) as pool:
            runs = [pool.submit(test_behaviour, edsc, folder / f"{row.program}-{row.name}", row, arguments.all_cases)
                    for row in rows]
            problems = [text for run in runs for text in run.result()]
    finally:
        if not arguments.keep:
            shutil.rmtree(folder)
    print("\n".join(problems), end="\n" if problems else "")
    print(f"{len(rows)} behaviours, {time.monotonic() - began:.1f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
