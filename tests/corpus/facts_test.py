#!/usr/bin/env python3
"""Compares `edsc dump` of real EDS files with facts that were determined by hand from their lines: facts.tsv.

    facts_test.py SOURCE_DIR EDSC

The corpus is not part of this repository (see corpus_test.py); without it the test is skipped.
"""

from __future__ import annotations

import json
import math
import re
import struct
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus_test import find_corpus  # noqa: E402
from support.compilers import SKIPPED  # noqa: E402

SECONDS = 600
MEMBERS = {"default": "default_value", "low": "low_limit", "high": "high_limit", "type": "data_type",
           "mapping": "pdo_mapping"}
FORMULA = re.compile(r"\$NODEID(?:\+(0x[0-9A-F]+))?$")


class Fact(NamedTuple):
    line: int
    index: str
    sub_index: str
    key: str
    expected: str


def read_facts(path: Path) -> dict[tuple[str, str], list[Fact]]:
    """Returns the facts of each file and node-ID, in the order of facts.tsv."""
    runs: dict[tuple[str, str], list[Fact]] = {}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line and not line.startswith("#"):
            file, node_id, *fact = line.split("\t")
            runs.setdefault((file, node_id), []).append(Fact(number, *fact))
    return runs


def dump(edsc: Path, path: Path, node_id: str) -> dict:
    command = [edsc, "dump", "--keep-going", str(path)]
    if node_id != "-":
        command += ["--node-id", node_id]
    run = subprocess.run(command, capture_output=True, timeout=SECONDS)
    if not run.stdout:
        raise LookupError(f"there is no device: exit code {run.returncode}")
    return json.loads(run.stdout)


def at_path(device: dict, path: str) -> object:
    node = device
    for part in path.strip("/").split("/"):
        if isinstance(node, list):
            node = node[int(part)]
        else:
            node = node.get(part) if node is not None else None
    return node


def pdo_value(device: dict, label: str, position: str, key: str) -> object:
    direction = "receive" if label.startswith("RPDO") else "transmit"
    for pdo in device["pdos"]:
        if pdo["direction"] == direction and pdo["number"] == int(label[4:]):
            entry = pdo["entries"][int(position) - 1]
            return f"{entry['index']:04X}:{entry['sub_index']:02X}" if key == "object" else entry[key]
    return None


def value_of(device: dict, fact: Fact) -> object:
    index, sub_index, key = fact.index, fact.sub_index, fact.key
    if index == "-":
        return at_path(device, key)
    if index[1:4] == "PDO":
        return pdo_value(device, index, sub_index, key)
    found = next((o for o in device["objects"] if o["index"] == int(index, 16)), None)
    if found is not None and sub_index != "-":
        found = next((e for e in found["entries"] if e["sub_index"] == int(sub_index, 16)), None)
    if key == "exists":
        return found is not None
    if found is None:
        raise LookupError("there is no such entry")
    if key == "default" and "parameter_value" in found:  # the value of a DCF replaces the default
        return found["parameter_value"]
    return found.get(MEMBERS.get(key, key), 0 if key == "obj_flags" else None)


def constant_of(formula: str) -> int | None:
    match = FORMULA.match(formula)
    return None if match is None else int(match[1] or "0", 16)


def same_real(expected: str, actual: float) -> bool:
    if not re.fullmatch(r"-?\d+\.\d+", expected):
        return False
    single = struct.unpack("f", struct.pack("f", float(expected)))[0]
    return math.isclose(float(expected), actual, rel_tol=1e-15) or math.isclose(single, actual, rel_tol=1e-7)


def is_same(expected: str, actual: object) -> bool:
    if actual is None:
        return expected == "none"
    if isinstance(actual, bool):
        return expected == ("true" if actual else "false")
    if isinstance(actual, float):
        return same_real(expected, actual)
    if isinstance(actual, int):
        return re.fullmatch(r"-?\d+|0x[0-9A-Fa-f]+", expected) is not None and int(expected, 0) == actual
    if isinstance(actual, list):
        return [int(item, 0) for item in expected.split()] == actual
    if constant_of(expected) is not None and constant_of(actual) is not None:
        return constant_of(expected) == constant_of(actual)
    return expected == actual


def check(device: dict, facts: list[Fact]) -> list[str]:
    """Returns the wrong facts of one device."""
    problems = []
    for fact in facts:
        try:
            actual = value_of(device, fact)
        except LookupError as problem:
            actual = f"({problem})"
        if not is_same(fact.expected, actual):
            label = f"{fact.index}:{fact.sub_index} {fact.key}"
            problems.append(f"line {fact.line}: {label} is {fact.expected}, not {actual}")
    return problems


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    corpus = find_corpus(source_dir)
    if corpus is None:
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
        return SKIPPED
    runs = read_facts(Path(__file__).with_name("facts.tsv"))
    wrong = 0
    for (file, node_id), facts in runs.items():
        try:
            problems = check(dump(edsc, corpus / "files" / file, node_id), facts)
        except (LookupError, subprocess.TimeoutExpired) as problem:
            problems = [str(problem)]
        for problem in problems:
            print(f"{file}: {problem}")
        wrong += len(problems)
    print(f"{sum(map(len, runs.values()))} facts about {len({file for file, _ in runs})} files, {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
