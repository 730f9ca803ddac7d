#!/usr/bin/env python3
"""All JSON of edsc has one style: `"schema"` is the format number, an index is text, a time is a number with the unit in its name.
Each command that can write JSON has a row.

    json_style_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from collections.abc import Iterator
from typing import Any

from live import EDSC, LiveTest

LANGUAGE = json.loads(subprocess.run([EDSC, "completion", "json"], capture_output=True, text=True, check=True).stdout)
LOG = """(1.000000) can0 705#05
(1.100000) can0 185#0102030405060708
(1.300000) can0 605#4018100100000000
(1.301000) can0 585#4318100193000000
(1.400000) can0 705#05
(1.500000) can0 605#4018100600000000
(1.501000) can0 585#8018100611000906
"""
ADDRESS = re.compile(r"^[0-9A-F]{4}h:[0-9A-F]{2}$")
TIME = re.compile(r"(^|_)(time|times|period|delay|duration|age|ago|span|jitter|seconds|milliseconds|microseconds)(_|$)")
UNIT = re.compile(r"_(us|ms)$")
# Data for templates: index and sub-index are numbers, the parameters of a PDO have the units of their objects.
NUMERIC = {"dump"}

# The words of a command that writes JSON to standard output, or to the file %; @ is BUS. Several rows: several kinds of output.
ROWS = {
    "check": ("check bad.eds --format json", "check --list-rules --format json", "check --list-options --format json",
              "check --explain pdo-length --format json"),
    "dump": ("dump device.eds",),
    "diff": ("diff device.eds other.eds --format json", "diff --storage device.eds other.eds --format json"),
    "network check": ("network check line.json --times --format json",),
    "network members": ("network members --format json",),
    "network simulate": ("network simulate line.json --for 1s --format json",),
    "network verify": ("network verify @ line.json --format json --timeout 60s",),
    "network apply": ("network apply @ line.json --format json --timeout 60s",),
    "scan": ("scan @ --nodes 5 --eds device.eds --timeout 1s --for 10ms --format json",),
    "read": ("read @ 5 --all --eds device.eds --timeout 60s --format json", "read @ 5 2006h --timeout 60s --format json"),
    "configure": ("configure @ 5 axis1.dcf --all --dry-run --format json", "configure @ 5 axis1.dcf --format json --timeout 60s"),
    "save": ("save @ 5 device.eds -o saved.dcf --format json --timeout 60s",),
    "monitor": ("monitor @ --node 5=device.eds --once 300ms --format json",),
    "watch": ("watch can0.log --network line.json --format json", "watch --list-alarms --format json"),
    "lss assign": ("lss @ assign --node-id 6 --format json --timeout 10ms --step 5ms",),
    "lss fastscan": ("lss @ fastscan --format json --timeout 10ms --step 5ms",),
    "lss inquire": ("lss @ inquire --format json --timeout 10ms",),
    "conform": ("conform @ 5 device.eds --only 2.1 --json % --timeout 60s",),
    "accept": ("accept @ 5 device.eds --only 2.1 --json % --timeout 60s",),
    "decode": ("decode can0.log --node 5=device.eds --summary --format json",),
    "audit": ("audit can0.log --node 5=device.eds --format json", "audit --list-rules --format json"),
    "replay": ("replay can0.log --node 5=device.eds --all-differences --format json",),
    "discover": ("discover can0.log --format json",),
    "completion": ("completion json",),
}
# Without a device in LSS configuration state they write no JSON; lss_test.py has such devices.
WITHOUT_DEVICE = {"lss assign", "lss inquire"}


def writes_json(command: dict) -> bool:
    words = {word for option in (*command["options"], *command["arguments"]) for word in option.get("words", [])}
    return "json" in words or any(option["names"] == ["--json"] for option in command["options"])


def documents_of(text: str) -> list[Any]:
    """One document, or one on each line."""
    documents, rest = [], text.strip()
    while rest:
        document, end = json.JSONDecoder().raw_decode(rest)
        documents.append(document)
        rest = rest[end:].lstrip()
    return documents


def members(value: Any, path: str = "") -> Iterator[tuple[str, str, Any]]:
    """Each member: its place, its name and its value."""
    if isinstance(value, list):
        for one in value:
            yield from members(one, path + "[]")
    if isinstance(value, dict):
        for name, one in value.items():
            yield path, name, one
            yield from members(one, f"{path}.{name}")


def is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


class JsonStyle(LiveTest):
    def setUp(self) -> None:
        super().setUp()
        (self.folder / "can0.log").write_text(LOG)
        text = (self.folder / "device.eds").read_text()
        (self.folder / "bad.eds").write_text(text.replace("AccessType=rw", "AccessType=ro", 1) + "\n[9999]\nParameterName=x\n")
        (self.folder / "other.eds").write_text(text.replace("AccessType=rw", "AccessType=ro", 1))
        network = {"bit_rate": 500, "nodes": {"axis1": {"node_id": 5, "eds": "device.eds", "set": {"1017h": 1000}}}}
        (self.folder / "line.json").write_text(json.dumps(network))
        self.output_of("format device.eds --dcf --node-id 5 -o axis1.dcf")
        dcf = self.folder / "axis1.dcf"
        dcf.write_text(re.sub(r"(\[1017\][^\[]*)", r"\1ParameterValue=700\n", dcf.read_text(), count=1))

    def output_of(self, words: str) -> str:
        written = self.folder / "written.json"
        written.unlink(missing_ok=True)
        arguments = [word.replace("%", str(written)).replace("@", self.network.address) for word in words.split()]
        result = subprocess.run([EDSC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return written.read_text() if written.exists() else result.stdout

    def problems_of(self, command: str, document: Any) -> set[str]:
        if not isinstance(document, dict):
            return {"is not an object"}
        problems = set()
        if not isinstance(document.get("schema"), int) or "version" in document:
            problems.add("no format number in schema")
        for path, name, value in members(document):
            if path.endswith(".fields"):  # named in the EDS
                continue
            if command not in NUMERIC and name == "sub_index":
                problems.add(f"{path}.{name}")
            if command not in NUMERIC and name == "index" and value is not None and not ADDRESS.match(str(value)):
                problems.add(f"{path}.{name} = {value}")
            if command not in NUMERIC and is_number(value) and TIME.search(name) and not UNIT.search(name):
                problems.add(f"{path}.{name}: no unit")
        return problems

    def test_each_command_has_a_row(self) -> None:
        commands = {command["command"] for command in LANGUAGE["commands"] if writes_json(command)}
        self.assertEqual(commands | {"dump"}, set(ROWS))

    def test_is_that_of_each_output(self) -> None:
        addresses = 0
        for command, rows in ROWS.items():
            for words in rows:
                with self.subTest(words=words):
                    output = self.output_of(words)
                    documents = documents_of(output or "null")
                    if command in WITHOUT_DEVICE and documents == [None]:
                        continue
                    self.assertNotEqual(documents, [])
                    for document in documents:
                        self.assertEqual(self.problems_of(command, document), set())
                        addresses += sum(name == "index" for _, name, _ in members(document))
        self.assertGreater(addresses, 60)

    def test_is_tested(self) -> None:
        for wrong in ({"version": 1}, {}, [], {"schema": 1, "index": 4120}, {"schema": 1, "a": [{"sub_index": 1}]},
                      {"schema": 1, "time": 1.5}, {"schema": 1, "a": {"delay": 3}}):
            self.assertNotEqual(self.problems_of("read", wrong), set(), wrong)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
