#!/usr/bin/env python3
"""A node of a bus or log has the name that the network file gives it: in each command that takes a NODE or --node, the name has
the result of the node-ID and its EDS.

    node_names_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import unittest

from live import EDSC, FINE, WRONG_USAGE, LiveTest

LANGUAGE = json.loads(subprocess.run([EDSC, "completion", "json"], capture_output=True, text=True, check=True).stdout)
LOG = """(1.000000) can0 705#05
(1.100000) can0 185#0102030405060708
(1.200000) can0 705#05
(1.300000) can0 605#4018100100000000
(1.301000) can0 585#4318100193000000
"""
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("EDSC_")}

# The words of a command with a node-ID and its EDS, and those with the name. @ is BUS, % a file that the command writes. `write`
# starts heartbeats, which a short `monitor` may receive or not.
ROWS = {
    "monitor": ("monitor @ --node 5=device.eds --once 10ms --bit-rate 500", "monitor @ --node axis1 --once 10ms"),
    "read": ("read @ 5 1018h --eds device.eds --timeout 60s", "read @ axis1 1018h --timeout 60s"),
    "write": ("write @ 5 1017h 500 --eds device.eds --timeout 60s", "write @ axis1 1017h 500 --timeout 60s"),
    "configure": ("configure @ 5 axis1.dcf --dry-run --timeout 60s", "configure @ axis1 axis1.dcf --dry-run --timeout 60s"),
    "save": ("save @ 5 device.eds -o % --timeout 60s", "save @ axis1 -o % --timeout 60s"),
    "nmt": ("nmt @ pre-operational 5", "nmt @ pre-operational axis1"),
    "send pdo": ("send @ pdo 5 1 6040h=6 60FFh=0 --eds device.eds", "send @ pdo axis1 1 6040h=6 60FFh=0"),
    "lss node-id": ("lss @ node-id 5 --timeout 10ms", "lss @ node-id axis1 --timeout 10ms"),
    "conform": ("conform @ 5 device.eds --only 2.1 --quiet --timeout 60s", "conform @ axis1 --only 2.1 --quiet --timeout 60s"),
    "accept": ("accept @ 5 device.eds --only 2.1 --quiet --timeout 60s", "accept @ axis1 --only 2.1 --quiet --timeout 60s"),
    "overlay from-bus": ("overlay from-bus @ 5 device.eds -o % --timeout 60s", "overlay from-bus @ axis1 -o % --timeout 60s"),
    "decode": ("decode can0.log --node 5=device.eds", "decode can0.log --node axis1"),
    "audit": ("audit can0.log --node 5=device.eds --master 5 --bit-rate 500", "audit can0.log --node axis1 --master axis1"),
    "replay": ("replay can0.log --node 5=device.eds", "replay can0.log --node axis1"),
    "plot": ("plot can0.log 1018h:01 --node 5=device.eds -o %", "plot can0.log 1018h:01 --node axis1 -o %"),
}


NEW_NODES = {"node"}  # their EDS files need not be in a network file


def takes_node(command: dict) -> bool:
    if command["command"] in NEW_NODES:
        return False
    return any(argument["names"] == ["NODE"] for argument in command["arguments"]) or any(
        option["names"] == ["--node"] for option in command["options"])


class NodeNames(LiveTest):
    def setUp(self) -> None:
        super().setUp()
        (self.folder / "can0.log").write_text(LOG)
        network = {"bit_rate": 500, "nodes": {"axis1": {"node_id": 5, "eds": "device.eds"}}}
        (self.folder / "line.json").write_text(json.dumps(network))
        made = self.run_edsc("format device.eds --dcf --node-id 5 -o axis1.dcf")
        self.assertEqual(made.returncode, FINE, made.stderr)

    def run_edsc(self, words: str, output: str = "out", **environment: str) -> subprocess.CompletedProcess[str]:
        arguments = [word.replace("%", output).replace("@", self.network.address) for word in words.split()]
        return subprocess.run([EDSC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600,
                              stdin=subprocess.DEVNULL, env={**ENVIRONMENT, **environment})

    def result(self, words: str, **environment: str) -> tuple[int, str, str, str]:
        """What the command prints and writes, without the name of the node and times of day. `edsc monitor` has the name
        in place of the product."""
        output = self.folder / "out"
        output.unlink(missing_ok=True)
        result = self.run_edsc(words, **environment)
        written = output.read_text() if output.exists() else ""
        texts = (re.sub(r"[\d.]+ ms|\d\d:\d\d[:\d]*", "TIME", re.sub(" +", " ", re.sub(r"^( +5 +)axis1 ", r"\1Live device ", text.replace("node 5 axis1", "node 5"), flags=re.MULTILINE)))
                 for text in (result.stdout, result.stderr, written))
        return (result.returncode, *texts)

    def test_are_known_to_each_command_with_a_node(self) -> None:
        commands = {command["command"]: command for command in LANGUAGE["commands"] if takes_node(command)}
        self.assertEqual(set(commands), set(ROWS))
        for name, command in commands.items():
            self.assertIn(["--network"], [option["names"] for option in command["options"]], name)

    def test_have_the_result_of_the_node_id_and_its_eds(self) -> None:
        for name, (by_number, by_name) in ROWS.items():
            with self.subTest(command=name):
                expected = self.result(by_number)
                self.assertNotEqual(expected[0], WRONG_USAGE, expected)
                self.assertEqual(self.result(by_name, EDSC_NETWORK="line.json"), expected)
                self.assertEqual(self.result(by_name + " --network line.json"), expected)

    def test_need_a_network_file(self) -> None:
        for name, (_, by_name) in ROWS.items():
            with self.subTest(command=name):
                result = self.run_edsc(by_name)
                self.assertEqual(result.returncode, WRONG_USAGE, result.stderr)
                self.assertIn("axis1", result.stderr)

    def test_that_are_misspelt_are_reported(self) -> None:
        for name, (_, by_name) in ROWS.items():
            if "--node" in by_name:
                continue
            with self.subTest(command=name):
                result = self.run_edsc(by_name.replace("axis1 ", "axsi1 ", 1) if "axis1 " in by_name
                                       else by_name.replace("axis1", "axsi1"), EDSC_NETWORK="line.json")
                self.assertEqual(result.returncode, WRONG_USAGE)
                self.assertIn('NODE: "axsi1" is not a node-ID from 1 to 127 and not a node of line.json; did you mean "axis1"?',
                              result.stderr)

    def test_are_not_needed_for_the_eds_of_a_node_id(self) -> None:
        expected = self.result(ROWS["read"][0])
        self.assertEqual(self.result("read @ 5 1018h --timeout 60s --network line.json"), expected)

    def test_may_have_another_eds(self) -> None:
        named = self.result("decode can0.log --node axis1=device.eds", EDSC_NETWORK="line.json")
        self.assertEqual(named, self.result("decode can0.log --node 5=device.eds"))

    def test_of_a_master_without_a_file(self) -> None:
        """The names of its objects are not known before the network is generated; its log is checked against that EDS."""
        network = {"bit_rate": 500, "nodes": {"axis1": {"node_id": 5, "eds": "device.eds"},
                                              "plc": {"node_id": 127, "master": True, "heartbeat_ms": 100}}}
        (self.folder / "plant.json").write_text(json.dumps(network))
        for command in ("read @ plc device_name", "write @ plc device_name 5"):
            result = self.run_edsc(command + " --network plant.json")
            self.assertEqual(result.returncode, WRONG_USAGE)
            self.assertIn('"device_name" is not an address such as 1018h:01; the network file states no EDS of node plc', result.stderr)
        (self.folder / "plc.log").write_text("".join(f"({1 + i / 10:.6f}) can0 77F#05\n" for i in (0, 1, 2, 12)))
        found = self.run_edsc("audit plc.log --format json --network plant.json")
        rules = [(one["rule"], one["node_id"]) for one in json.loads(found.stdout)["findings"]]
        self.assertIn(("heartbeat-late", 127), rules)
        self.assertNotIn(("node-unknown", 127), rules)

    def test_monitor_has_the_names_and_the_bit_rate_of_the_network(self) -> None:
        result = self.run_edsc("monitor @ --once 100ms --format json --network line.json")
        found = json.loads(result.stdout)
        self.assertEqual([(one["node_id"], one["name"]) for one in found["nodes"]], [(5, "axis1")])
        self.assertIsNotNone(found["load_percent"])

    def test_select_the_frames_of_a_log(self) -> None:
        (self.folder / "two.log").write_text(LOG + "(1.400000) can0 706#05\n")
        all_frames = self.run_edsc("decode two.log --network line.json").stdout
        selected = self.run_edsc("decode two.log --network line.json --filter node=axis1").stdout
        self.assertEqual(selected.splitlines(), [line for line in all_frames.splitlines() if " axis1 " in line])
        self.assertEqual(len(selected.splitlines()), 5)
        result = self.run_edsc("decode two.log --network line.json --filter node=axsi1")
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
        self.assertIn('"axsi1" is not a node-ID from 1 to 127 and not the name of a node; did you mean "axis1"?', result.stderr)

    def test_of_a_missing_network_file(self) -> None:
        result = self.run_edsc("read @ axis1 1018h --network missing.json")
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
        self.assertIn("missing.json", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
