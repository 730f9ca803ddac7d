#!/usr/bin/env python3
"""What edsc says about wrong command lines: made from the table of commands and options, with the messages that a person has reviewed.

    wrong_usage_test.py SOURCE_DIR EDSC [--write] [unittest arguments]

--write writes wrong_usage.txt; read each message that changes before you commit it. A message says what is wrong, names the option or
argument, and if it can, what to write.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path

EDSC = Path(sys.argv[2]).resolve()
REVIEWED = Path(__file__).with_name("wrong_usage.txt")
WRONG_USAGE = 2
BUS = "socketcand:127.0.0.1:1/vcan0"  # no server listens there
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("EDSC_")}
LANGUAGE = json.loads(subprocess.run([EDSC, "completion", "json"], capture_output=True, text=True, check=True).stdout)
COMMANDS = {one["command"]: one for one in LANGUAGE["commands"]}
HAS_COMMANDS = {name.rsplit(" ", 1)[0] for name in COMMANDS if " " in name} | {""}
LEAVES = [one for name, one in COMMANDS.items() if name not in HAS_COMMANDS]
# A value that is not of the kind of an option or argument.
WRONG_VALUES = {"number": "many", "duration": "5", "word": "nonsense", "address": "nowhere", "rule": "no-such-rule",
                "case_command": "reboot", "node": "300", "bus": "can0"}
# Two that contradict each other, and one without the other that it needs.
BY_HAND = (
    "read {bus} 5 1018h --raw --output x", "read {bus} 5 1018h --block --segmented", "read {bus} 5 --all", "read {bus} 5",
    "read {bus} 5 --all 1018h --eds device.eds", "write {bus} 5 1017h 5 --file value.bin", "write {bus} 5 1017h",
    "monitor {bus} --once 1s --web", "monitor {bus} --web=nowhere", "monitor {bus} --format json", "monitor {bus} --node 5", "monitor {bus} --node 300=device.eds",
    "monitor {bus} --node 5=device.eds --node 5=device.eds", "send {bus} pdo 5 1", "send {bus} pdo 5 0 --eds device.eds",
    "send {bus} frame 181", "send {bus} time yesterday", "send {bus} sync --overflow 1", "lss {bus} assign --node-id 128",
    "lss {bus} assign --node-id 5 --product 1", "lss {bus} bit-rate 33", "lss {bus} state operational", "nmt {bus} start 128",
    "nmt {bus} begin 5", "nmt {bus} start all --wait 1s", "nmt start 5", "scan {bus} --step 20ms", "scan {bus} --nodes 1..200",
    "scan {bus} --eds no_such.eds", "configure {bus} 5 device.eds", "configure {bus} 5 x.dcf --eds device.eds",
    "conform {bus} 5", "conform {bus} 5 device.eds --only 99.9", "conform {bus} axis1", "conform --level all", "conform {bus} 5 no_such.eds",
    "conform {bus} 5 device.eds --deviations no_such.json", "accept {bus} 5 folder", "decode no_such.log", "decode folder",
    "decode bus.log --node axis1", "decode bus.log --node 5", "decode bus.log --filter nod=5", "decode bus.log --network no_such.json",
    "audit bus.log --node 5=device.eds --master 0", "plot bus.log", "plot bus.log 1017h", "check no_such.eds", "check",
    "check empty_folder", "check device.eds --node-id 0", "check device.eds --options no_such.json", "dump folder", "dump no_such.eds",
    "format device.eds other.eds -o x.eds", "format device.eds --check --in-place", "format device.eds --dcf", "generate device.eds",
    "generate device.eds -o file.txt", "generate device.eds -o out --templates no_such", "generate device.eds -o out --name 1x",
    "diff device.eds", "diff device.eds no_such.eds", "diff device.eds --against git:no_such", "document no_such.eds",
    "network", "network check no_such.json", "network generate no_such.json -o x", "network verify {bus} no_such.json",
    "network scan {bus} --eds no_such.eds -o x.json", "network simulate bad.json", "overlay from device.eds",
    "overlay apply device.eds", "bus vcan/0", "bus --listen 127.0.0.1", "record {bus} --log-interface a/b", "record {bus} --count 0",
    "record slcan:/dev/no_such", "record simulated:./no_such@5", "completion fish", "help chek", "chek device.eds",
    "read {bus} 5 1018h --timeout 5 --tmeout", "check device.eds --force", "check -x device.eds", "--verson", "", "version 1",
    "check device.eds --strict=5", "read {bus} 5 no_such_name", "read {bus} 5 1018h --type u7", "save {bus} 5", "audit bus.log --silence x", "audit bus.log --times",
    "watch", "watch bus.log", "watch bus.log --network no_such.json", "watch bus.log --network bad.json --allow x", "watch bus.log --silence x",
    "watch bus.log --network bad.json --for 1s", "watch {bus} --network bad.json --silence sdo-write --exit-on sdo-write",
    "replay bus.log", "replay bus.log can0", "replay no_such.log --node 5=device.eds", "replay bus.log {bus} --speed 0",
    "replay bus.log {bus}", "replay bus.log --node 5=device.eds --ignore no_such_name", "discover no_such.log",
    "discover bus.log --eds no_such.eds -o x.json", "discover bus.log --eds device.eds", "discover bus.log --for 1ms",
)


def words_of(command: dict) -> list[str]:
    return ["{bus}" if word == "BUS" else word for word in command["usage"].split(" [OPTIONS]")[0].split()[1:]]


def made() -> Iterator[str]:
    """For each command an unknown option, its first required argument missing; for each option, at one command, a misspelt name, no
    value, and a value of the wrong kind."""
    seen = set()
    for command in LEAVES:
        start = " ".join(words_of(command))
        yield f"{start} --no-such-option"
        if any(argument["required"] for argument in command["arguments"]):
            yield start
        for option in command["options"]:
            name = option["names"][-1]
            kind = option["kind"]
            if name in seen or name in ("--help", "--version"):
                continue
            seen.add(name)
            if len(name) > 6:
                yield f"{start} {name[:4]}{name[5:]}"
            if option["value"] and name != "--web":
                yield f"{start} {name}"
            if kind in WRONG_VALUES:
                yield f"{start} {name} {WRONG_VALUES[kind]}"


INVOCATIONS = tuple(dict.fromkeys((*made(), *BY_HAND)))


def messages() -> str:
    texts = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for one in ("folder", "empty_folder"):
            (folder / one).mkdir()
        sheet = (Path(sys.argv[1]) / "tests/fixtures/live_device.eds").read_text(encoding="utf-8")
        (folder / "device.eds").write_text(sheet)
        (folder / "other.eds").write_text(sheet)
        (folder / "bus.log").write_text("(1.0) can0 705#05\n")
        (folder / "bad.json").write_text("{}")
        (folder / "file.txt").write_text("")
        (folder / "value.bin").write_bytes(b"1")
        for invocation in INVOCATIONS:
            words = [word.replace("{bus}", BUS) for word in invocation.split()]
            result = subprocess.run([EDSC, *words], cwd=folder, capture_output=True, text=True, timeout=60, env=ENVIRONMENT,
                                    stdin=subprocess.DEVNULL, check=False)
            lines = (result.stderr + result.stdout).replace(name, "FOLDER").splitlines(keepends=True)
            output = "".join(lines[:10])
            texts.append(f"$ edsc {invocation}\n{output}" + (f"exit code {result.returncode}\n" if result.returncode != WRONG_USAGE else ""))
    return "\n".join(texts)


class WrongUsage(unittest.TestCase):
    maxDiff = None

    def test_there_are_enough(self) -> None:
        self.assertGreater(len(INVOCATIONS), 100)
        used = {name for invocation in INVOCATIONS for name in invocation.split() if name.startswith("--")}
        self.assertGreater(len(used & {row["name"] for row in LANGUAGE["vocabulary"]}), 60)

    def test_messages_are_those_that_were_reviewed(self) -> None:
        self.assertEqual(messages(), REVIEWED.read_text(encoding="utf-8"))

    def test_begin_with_the_program_or_a_file(self) -> None:
        for block in REVIEWED.read_text(encoding="utf-8").split("\n\n$ "):
            first = block.split("\n")[1]
            self.assertRegex(first, r"^(edsc|[\w.]+(:\d+:\d+)?): ", block)


if __name__ == "__main__":
    if "--write" in sys.argv:
        REVIEWED.write_text(messages(), encoding="utf-8")
        sys.argv.remove("--write")
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
