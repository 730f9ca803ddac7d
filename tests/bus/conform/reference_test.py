#!/usr/bin/env python3
"""edsc conform with the reference devices: each runnable node on its own bus, all cases with the hostile ones, in real time.

    reference_test.py SOURCE_DIR EDSC NODES_DIR [--only NAME]... [--bus ADDRESS] [--keep FOLDER]

Each case passes, fails as NAME.deviations.json beside the EDS declares, is not applicable, or is inconclusive because the
test or the node was late. Lines on the standard input of a node are the stimuli. Each other failure is an error, however busy
the computer is. A case whose repetition has another verdict runs again alone, at most `TRIES` times. With --bus the nodes run one after the other on this bus, such as socketcan:vcan0.
"""

from __future__ import annotations

import argparse
import re
import shlex
import shutil
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from bench import NODE_ID, TRIES, Bench, is_late, patterns, run_problems  # noqa: E402

EVENTS = ("3.4", "3.7", "3.10", "3.13", "3.16", "3.19")
ERRORS = ("5.4", "5.5", "5.6", "5.103", "5.105", "5.106", "9.2", "9.3", "9.4")
POWER = ("8.2", "8.6", "8.101", "8.102")
NEEDS_ERROR = ("5.103", "5.106")  # inconclusive if the program of the device cannot cause an error
SIMULATED = ("5.104",)  # inconclusive in real time


# Each part on its own bus, because most of the time is waiting.
PARTS = (("1.*", "2.*", "3.*", "4.*", "5.*", "6.*", "8.*"), ("7.*", "9.*", "10.*", "11.*"), ("12.*",))


@dataclass(frozen=True)
class Device:
    """`tested`: minimum number of applicable cases. The others are input lines for the node; `changes` alternate."""
    tested: int
    changes: tuple[tuple[str, ...], ...] = ()
    error: str = ""
    error_over: str = ""

    def lines(self) -> dict[str, list[str]]:
        """Returns the lines for each value of EDSC_STIMULUS, with the number of a change."""
        found = {"power_cycle": ["power-cycle"]}
        found |= {f"change{i}": list(lines) for i, lines in enumerate(self.changes)}
        if self.error:
            found |= {"error": [self.error], "error_over": [self.error_over]}
        return found


MODULE_ERROR = {"error": "fault eeprom", "error_over": "fault over"}
LIMIT_SWITCH = (("limit positive on",), ("limit positive off",))  # bit 11 of 6041h, which TPDO 1 maps
DEVICES = {
    "can_2017c": Device(89, (("analogue 1 5.0", "analogue 5 5.0"), ("analogue 1 2.0", "analogue 5 2.0")), **MODULE_ERROR),
    "can_2024c": Device(74, **MODULE_ERROR),
    "can_2053c": Device(97, (("digital 1 0x55",), ("digital 1 0xAA",)), **MODULE_ERROR),
    "can_2057c": Device(73, **MODULE_ERROR),
    "cpc_tc1": Device(110, LIMIT_SWITCH, "fault 0x3210 0x04", "fault-over 0x04"),
    "cpd": Device(101, LIMIT_SWITCH),
    "ezd_1136": Device(96, LIMIT_SWITCH),
    "rk5c": Device(76, (("position 1 12345",), ("position 1 23456",)), "hardware bad", "hardware good"),
}


@dataclass
class Outcome:
    name: str
    problems: list[str] = field(default_factory=list)
    verdicts: Counter = field(default_factory=Counter)
    again: list[str] = field(default_factory=list)
    seconds: float = 0.0

    def add(self, other: Outcome) -> None:
        self.problems += other.problems
        self.verdicts += other.verdicts
        self.again += other.again
        self.seconds = max(self.seconds, other.seconds)


def quoted_lines(lines: list[str]) -> str:
    return f"printf '%s\\n' {' '.join(map(shlex.quote, lines))} > lines"


def stimulus_script(device: Device) -> str:
    """Returns a shell script that writes the lines for EDSC_STIMULUS to the node; exit code 1 if there are none."""
    rows = [f"{what}) {quoted_lines(lines)} ;;" for what, lines in device.lines().items()]
    return "\n".join(['cd "$(dirname "$0")" || exit 1', 'what=$EDSC_STIMULUS', 'if [ "$what" = change ]; then',
                      '  if [ -e odd ]; then rm odd; what=change0; else : > odd; what=change1; fi', 'fi',
                      'case $what in', *rows, '*) exit 1 ;;', 'esac', ''])


def case_problems(report: dict, device: Device) -> dict[str, str]:
    """Returns the problems of each case that another run may resolve."""
    problems = {}
    without_stimulus = SIMULATED if device.error else (*SIMULATED, *NEEDS_ERROR)
    for case in report["cases"]:
        if case["id"] in without_stimulus and case["verdict"] == "inconclusive":
            continue
        verdict = case["verdict"]
        if verdict == "failed":
            problems[case["id"]] = f"{case['title']}: expected {case['expected']}; got {case['got']}"
        elif verdict == "inconclusive" and not is_late(case):
            problems[case["id"]] = f"{case['title']}: inconclusive: {case['reason']}"
        elif verdict == "not_run":
            problems[case["id"]] = f"{case['title']}: not run: {case['reason']}"
    for text in report["unused_deviations"]:
        problems[re.search(r"case (\S+) passed", text)[1]] = f"unused deviation: {text}"
    return problems


def test_part(name: str, part: tuple[str, ...], source_dir: Path, edsc: Path, nodes: Path, folder: Path,
              address: str) -> Outcome:
    outcome = Outcome(name)
    began = time.monotonic()
    sheet = source_dir / "eds" / f"{name.replace('_', '-')}.eds"
    deviations = sheet.with_suffix(".deviations.json")
    options = ["--deviations", deviations] if deviations.is_file() else []
    bench = Bench(edsc, folder, address)
    try:
        bench.start_node([nodes / name], ["--node-id", NODE_ID], "pre-operational")
        script = folder / "stimulus"
        script.write_text(stimulus_script(DEVICES[name]), encoding="utf-8")
        options += [f"--stimulus={case}=sh {shlex.quote(str(script))}" for case in (*EVENTS, *ERRORS, *POWER)]
        report = bench.conform(sheet, folder / "report.json", *options, *patterns(part), level="hostile")
        outcome.verdicts = Counter(case["verdict"] for case in report["cases"])
        problems = case_problems(report, DEVICES[name])
        outcome.problems += run_problems(report)
        for again in range(1, TRIES):
            if not problems or report["verdicts"]["failed"]:
                break
            outcome.again += problems
            report = bench.conform(sheet, folder / f"report-{again}.json", *options, *patterns(problems), level="hostile")
            outcome.problems += run_problems(report)
            problems = case_problems(report, DEVICES[name])
        outcome.problems += [f"{case} {text}" for case, text in problems.items()]
    finally:
        bench.close()
    outcome.seconds = time.monotonic() - began
    return outcome


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("nodes", type=Path, help="the folder of the nodes' programs")
    parser.add_argument("--only", action="append", choices=[*DEVICES], help="this device, or one of several")
    parser.add_argument("--bus", default="", help="address of a bus without other nodes")
    parser.add_argument("--keep", type=Path, help="a new folder for the reports")
    arguments = parser.parse_args()
    folder = arguments.keep or Path(tempfile.mkdtemp(prefix="edsc-conform-"))
    began = time.monotonic()
    outcomes = {name: Outcome(name) for name in arguments.only or DEVICES}
    parts = (("*",),) if arguments.bus else PARTS
    tasks = [(name, part) for name in outcomes for part in range(len(parts))]

    def test(task: tuple[str, int]) -> Outcome:
        name, part = task
        return test_part(name, parts[part], arguments.source_dir.resolve(), arguments.edsc.resolve(), arguments.nodes.resolve(),
                         folder / f"{name}-{part}", arguments.bus)

    try:
        with ThreadPoolExecutor(1 if arguments.bus else len(tasks)) as pool:
            for outcome in pool.map(test, tasks):
                outcomes[outcome.name].add(outcome)
    finally:
        if not arguments.keep:
            shutil.rmtree(folder)
    for outcome in outcomes.values():
        tested = outcome.verdicts.total() - outcome.verdicts["not_applicable"]
        if tested < DEVICES[outcome.name].tested:
            outcome.problems.append(f"{tested} cases apply, expected {DEVICES[outcome.name].tested}")
        counts = ", ".join(f"{count} {verdict}" for verdict, count in sorted(outcome.verdicts.items()))
        print(f"{outcome.name}: {counts}; {outcome.seconds:.1f} s" + (f"; again: {', '.join(outcome.again)}" if outcome.again else ""))
        for problem in outcome.problems:
            print(f"    {problem}")
    print(f"{time.monotonic() - began:.1f} s")
    return 1 if any(outcome.problems for outcome in outcomes.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
