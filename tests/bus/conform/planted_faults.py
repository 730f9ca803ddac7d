#!/usr/bin/env python3
"""edsc conform finds faults that are planted in the sources of a device: in a copy of the runtime, from which the device with every
service is compiled and tested in simulated time.

    planted_faults.py SOURCE_DIR EDSC COMPILER [--only NAME]... [--jobs NUMBER] [--write]

planted_faults.tsv has a row for each fault: its name, the header, the statement or expression that occurs there once, what takes its
place, the cases that fail, and why if none does. \\n is a line end; in a longer text [[ and ]] are around what is replaced. One program
has all faults, and an environment variable selects one: each text becomes `if (planted(3)) { new } else { old }`, an expression
`(planted(3) ? (new) : (old))`. --write updates the cases. The unchanged device fails no case.
The summary also counts the faults of frames of mutants.tsv, which conform_mutants tests.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
TABLE, FRAME_FAULTS = FOLDER / "planted_faults.tsv", FOLDER / "mutants.tsv"
MIN_FOUND = 0.97
SELECTOR = """#pragma once

#include <cstdlib>
#include <type_traits>

inline const int planted_fault = std::getenv("EDSC_PLANTED_FAULT") ? std::atoi(std::getenv("EDSC_PLANTED_FAULT")) : -1;

/// Whether a fault is selected. None is while the compiler evaluates an expression.
constexpr bool planted(int fault) { return !std::is_constant_evaluated() && fault == planted_fault; }
"""
PROGRAM = """#include <canopen_sim/simulated_device.hpp>
#include <every_service/device.hpp>

int main(int argc, char** argv) { return canopen::simulate_device<every_service::Device>(argc, argv); }
"""


@dataclass(frozen=True)
class Fault:
    name: str
    header: str  # in runtime/include/canopen
    old: str
    new: str
    cases: str  # that fail, separated by blanks; `ended`: the run ended early
    reason: str  # why none fails

    def row(self) -> str:
        return "\t".join((self.name, self.header, self.old, self.new, self.cases, self.reason)) + "\n"


def read_faults() -> list[Fault]:
    return [Fault(*line.split("\t")) for line in TABLE.read_text(encoding="utf-8").splitlines()]


def place_of(text: str, fault: Fault) -> tuple[int, int]:
    """Returns the beginning and the end of what the fault replaces."""
    old = fault.old.replace("\\n", "\n")
    before, replaced, after = re.fullmatch(r"(?s)(.*)\[\[(.*)\]\](.*)", old).groups() if "[[" in old else ("", old, "")
    whole = before + replaced + after
    if text.count(whole) != 1:
        sys.exit(f"{TABLE.name}: {fault.name}: {fault.header} has the text {text.count(whole)} times, not once: {whole}")
    begin = text.index(whole) + len(before)
    return begin, begin + len(replaced)


def plant(text: str, faults: list[tuple[int, Fault]]) -> str:
    """Returns the source with these faults and their numbers."""
    places: dict[tuple[int, int], list[tuple[int, Fault]]] = {}
    for number, fault in faults:
        places.setdefault(place_of(text, fault), []).append((number, fault))
    for (begin, end), rows in sorted(places.items(), reverse=True):
        changed, is_statement = text[begin:end], text[begin:end].endswith(";")
        for number, fault in rows:
            new = fault.new.replace("\\n", "\n")
            changed = f"if (planted({number})) {{ {new} }} else {{ {changed} }}" if is_statement else f"(planted({number}) ? ({new}) : ({changed}))"
        text = text[:begin] + changed + text[end:]
    return text


class Device:
    """The program with all faults."""

    def __init__(self, source_dir: Path, edsc: Path, compiler: str, faults: list[Fault], folder: Path) -> None:
        self.edsc, self.folder, self.program = edsc, folder, folder / "device"
        self.sheet = source_dir / "tests/fixtures/every_service.eds"
        runtime = folder / "include"
        shutil.copytree(source_dir / "runtime/include", runtime)
        for name in {fault.header for fault in faults}:
            header = runtime / "canopen" / name
            rows = [(number, fault) for number, fault in enumerate(faults) if fault.header == name]
            header.write_text(plant(header.read_text(encoding="utf-8"), rows), encoding="utf-8")
        (folder / "planted.hpp").write_text(SELECTOR)
        (folder / "device.cpp").write_text(PROGRAM)
        subprocess.run([edsc, "generate", self.sheet, "-o", folder / "generated"], check=True, timeout=600)
        subprocess.run([compiler, "-std=c++20", "-O0", "-include", folder / "planted.hpp", f"-I{runtime}", f"-I{folder / 'generated'}",
                        folder / "device.cpp", "-o", self.program], check=True, timeout=600)

    def failed_cases(self, number: int) -> str:
        """Returns the cases that the device with this fault fails; -1: the unchanged device."""
        report = self.folder / f"{number}.json"
        subprocess.run([self.edsc, "conform", f"simulated:{self.program}@5", "5", self.sheet, "--level", "all", "--quiet", "--json", report],
                       env=os.environ | {"EDSC_PLANTED_FAULT": str(number)}, capture_output=True, timeout=600, check=False)
        result = json.loads(report.read_text())
        failed = [case["id"] for case in result["cases"] if case["verdict"] == "failed"]
        return " ".join(failed + (["ended"] if result["ended_early"] else []))


def problem_of(fault: Fault, cases: str) -> str:
    if cases != fault.cases:
        return f'{fault.name}: fails "{cases}", the table has "{fault.cases}"'
    if not cases and not fault.reason:
        return f"{fault.name}: no case fails, and the table has no reason"
    return f"{fault.name}: the table has a reason, but cases fail" if cases and fault.reason else ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("compiler")
    parser.add_argument("--only", action="append", metavar="NAME", help="this fault, or one of several")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--write", action="store_true", help="update the cases in the table")
    arguments = parser.parse_args()
    all_faults = read_faults()
    numbers = {fault: number for number, fault in enumerate(all_faults) if not arguments.only or fault.name in arguments.only}
    faults = list(numbers)
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="edsc-planted-") as folder:
        device = Device(arguments.source_dir.resolve(), arguments.edsc.resolve(), arguments.compiler, all_faults, Path(folder))
        with ThreadPoolExecutor(arguments.jobs) as pool:
            accusations, *results = pool.map(device.failed_cases, [-1, *numbers.values()])
    found = dict(zip(faults, results, strict=True))
    if arguments.write:
        rows = [replace(fault, cases=found[fault]) if fault in found else fault for fault in all_faults]
        TABLE.write_text("".join(fault.row() for fault in rows), encoding="utf-8")
        faults = [replace(fault, cases=found[fault]) for fault in faults]
        found = {fault: fault.cases for fault in faults}
    problems = [problem for fault in faults if (problem := problem_of(fault, found[fault]))]
    if accusations:
        problems.append(f"the unchanged device fails {accusations}")
    for problem in problems:
        print(problem)
    missed = [fault for fault in faults if not found[fault]]
    for fault in missed:
        print(f"not found: {fault.name}: {fault.reason}")
    frames = [line.partition("\t") for line in FRAME_FAULTS.read_text(encoding="utf-8").splitlines()]
    missed_frames = [name for name, _, cases in frames if not cases]
    for name in missed_frames:
        print(f"not found: {name}")
    total, missed_total = len(faults) + len(frames), len(missed) + len(missed_frames)
    share = 1 - missed_total / total
    print(f"{len(faults)} faults of sources, {len(missed)} not found; {len(frames)} faults of frames, {len(missed_frames)} not found; "
          f"{total - missed_total} of {total} found, {100 * share:.1f} %; false accusations of the unchanged device: "
          f"{len(accusations.split())}; {time.monotonic() - began:.1f} s")
    return 1 if problems or share < MIN_FOUND else 0


if __name__ == "__main__":
    sys.exit(main())
