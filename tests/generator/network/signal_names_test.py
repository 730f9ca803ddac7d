#!/usr/bin/env python3
"""Names and units of signals: of a network file, and of a DBC file that canmatrix has written. canmatrix also reads the DBC files
of edsc back.

    signal_names_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import configparser
import json
import logging
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

logging.disable(logging.CRITICAL)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import canmatrix
    import canmatrix.formats

SOURCE_DIR, EDSC = (Path(argument).resolve() for argument in sys.argv[1:3])
LONG_NAME = "position_of_the_first_axis_of_the_machine"


def plant(*signals: dict, **members: object) -> dict:
    return {"bit_rate": 500, "nodes": {
        "control": {"node_id": 127, "master": True},
        "a": {"node_id": 1, "eds": "node.eds"}, "b": {"node_id": 2, "eds": "node.eds"}}, "signals": list(signals), **members}


SENT = ({"from": "a", "object": "position", "to": ["b.target_position", "control"], "every_ms": 10},
        {"from": "a", "object": "speed", "to": ["b.target_speed", "control"], "every_ms": 10},
        {"from": "control", "object": "a.target_position", "event": True})


class SignalNames(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-names-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(SOURCE_DIR / "tests/generator/network/node.eds", self.folder)
        self.out = self.folder / "out"

    def generate(self, network: dict) -> str:
        (self.folder / "plant.json").write_text(json.dumps(network))
        result = subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "out", "--force"], cwd=self.folder,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stderr

    def matrix(self) -> canmatrix.CanMatrix:
        return canmatrix.formats.loadp_flat(str(self.out / "plant.dbc"))

    def signals(self) -> dict[tuple[int, int], canmatrix.Signal]:
        """By CAN-ID and start bit."""
        return {(frame.arbitration_id.id, signal.start_bit): signal for frame in self.matrix().frames for signal in frame.signals}

    def names(self) -> dict[tuple[int, int], str]:
        return {place: str(signal.attributes.get("SystemSignalLongSymbol", signal.name)) for place, signal in self.signals().items()}

    def compile(self, statement: str) -> None:
        result = subprocess.run(["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-I",
                                 SOURCE_DIR / "runtime/include", "-I", self.out, "-x", "c++", "-"],
                                input=f"#include <canopen/host/host_bus.hpp>\n#include <canopen/master.hpp>\n#include <canopen_plant/plant.hpp>\n#include <plant.hpp>\n{statement}\n", capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_names_of_the_network_file(self) -> None:
        position, speed, target = ({**one, "name": name} for one, name in zip(SENT, (LONG_NAME, "motor_speed", "goal")))
        self.generate(plant(position, speed, target))
        self.assertEqual(self.names(), {(0x181, 0): LONG_NAME, (0x181, 32): "motor_speed", (0x201, 0): "goal"})
        self.compile(f"using namespace plant::signals::a; using All = std::tuple<{LONG_NAME}, motor_speed, goal>;\n"
                     f"static_assert(sizeof(All*) != 0);")
        master = configparser.RawConfigParser(strict=True, comment_prefixes=(";",), delimiters=("=",))
        master.read_string((self.out / "control.eds").read_text(encoding="utf-8"))
        self.assertEqual({master[section]["ParameterName"] for section in ("2001sub1", "2001sub2", "2101sub1")},
                         {LONG_NAME, "motor_speed", "goal"})

    def test_the_unit_of_a_signal(self) -> None:
        text = (self.folder / "node.eds").read_text(encoding="utf-8")
        for section in ("2001", "2003"):
            text = re.sub(rf"(\[{section}\][^\[]*)Unit=\w+\n", r"\1", text)
        (self.folder / "node.eds").write_text(text, encoding="utf-8")
        (self.folder / "node.options.json").write_text('{"typed_values": true}')
        self.generate(plant({**SENT[0], "unit": "0.01 mm"}, SENT[1], {**SENT[2], "unit": "0.01 mm"}))
        position = self.signals()[0x181, 0]
        self.assertEqual((float(position.factor), float(position.offset), position.unit), (0.01, 0, "mm"))
        self.assertEqual(self.signals()[0x181, 32].unit, "rpm")  # of node.eds
        self.assertEqual((float(self.signals()[0x201, 0].factor), self.signals()[0x201, 0].unit), (0.01, "mm"))
        self.compile("void use(canopen::Plant<plant::Network, canopen::HostBus>& it) { static_cast<void>(it.a.target_position(5)); }")
        self.assertIn('Position" INTEGER32 in 0.01 mm', (self.out / "plant.hpp").read_text(encoding="utf-8"))

    def import_names(self, change: object, network: dict) -> str:
        """Generates, changes the DBC file by canmatrix, and generates with its names."""
        self.generate(network)
        matrix = self.matrix()
        change(matrix)
        canmatrix.formats.dumpp({"": matrix}, str(self.folder / "names.dbc"))
        return self.generate({**network, "dbc": "names.dbc"})

    def test_names_of_a_dbc_file(self) -> None:
        def rename(matrix: canmatrix.CanMatrix) -> None:
            for frame in matrix.frames:
                for signal in frame.signals:
                    signal.attributes.pop("SystemSignalLongSymbol", None)
                    signal.name = {"position": "AxisPosition", "speed": LONG_NAME}.get(signal.name, "Goal")
        self.assertNotIn("network-signal", self.import_names(rename, plant(*SENT)))
        self.assertEqual(self.names(), {(0x181, 0): "axis_position", (0x181, 32): LONG_NAME, (0x201, 0): "goal"})
        self.compile(f"using namespace plant::signals::a; using All = std::tuple<axis_position, {LONG_NAME}, goal>;\n"
                     "static_assert(sizeof(All*) != 0);")
        master = (self.out / "control.eds").read_text(encoding="utf-8")
        self.assertIn("ParameterName=axis_position\n", master)

    def test_the_name_of_a_signal_has_priority(self) -> None:
        def rename(matrix: canmatrix.CanMatrix) -> None:
            for frame in matrix.frames:
                for signal in frame.signals:
                    signal.name += "_of_the_file"
        self.import_names(rename, plant({**SENT[0], "name": "here"}, SENT[1], SENT[2]))
        self.assertEqual(self.names(), {(0x181, 0): "here", (0x181, 32): "speed_of_the_file",
                                        (0x201, 0): "a_commands_target_position_of_the_file"})

    def test_the_dbc_file_of_edsc_itself_changes_nothing(self) -> None:
        for file in (SOURCE_DIR / "eds").glob("ezd-1136.*"):  # its controlword and statusword have fields
            shutil.copy(file, self.folder)
        nodes = {"control": {"node_id": 127, "master": True}, "axis": {"node_id": 1, "eds": "ezd-1136.eds"}}
        network = {"bit_rate": 500, "nodes": nodes, "signals": [
            {"from": "axis", "object": "6041h", "to": "control", "every_ms": 10},
            {"from": "control", "object": "axis.6040h", "every_ms": 10}]}
        self.generate(network)
        before = (self.out / "plant.dbc").read_bytes()
        shutil.copy(self.out / "plant.dbc", self.folder / "names.dbc")
        self.assertNotIn("network-signal", self.generate({**network, "dbc": "names.dbc"}))
        self.assertEqual((self.out / "plant.dbc").read_bytes(), before)

    def test_what_does_not_match_is_reported_with_its_line(self) -> None:
        def add(matrix: canmatrix.CanMatrix) -> None:
            frame = matrix.frame_by_id(canmatrix.ArbitrationId(0x181))
            frame.add_signal(canmatrix.Signal("odd", start_bit=0, size=12))
            frame.add_signal(canmatrix.Signal("motorola", start_bit=32, size=16, is_little_endian=False))
            other = canmatrix.Frame("other", arbitration_id=canmatrix.ArbitrationId(0x123), size=8)
            other.add_signal(canmatrix.Signal("unknown", start_bit=0, size=8))
            matrix.add_frame(other)
        found = self.import_names(add, plant(*SENT))
        lines = (self.folder / "names.dbc").read_text(encoding="cp1252").splitlines()
        number = {name: next(i for i, line in enumerate(lines, 1) if re.match(rf" ?(SG_|BO_ \d+) {name} ?:", line))
                  for name in ("odd", "motorola", "other")}
        self.assertEqual(sorted(re.findall(r"names\.dbc:(\d+):1: warning: (.*) \[network-signal\]", found)), sorted([
            (str(number["odd"]), "signal odd of message a_tpdo_1: no PDO with 181h has an entry of bits 0 to 11"),
            (str(number["motorola"]), "signal motorola of message a_tpdo_1: it is multiplexed or big-endian, unlike the values of a PDO"),
            (str(number["other"]), "message other has 123h, the CAN-ID of no PDO of the network")]))

    def test_the_dbc_file_is_an_input(self) -> None:
        self.generate(plant(*SENT))
        shutil.copy(self.out / "plant.dbc", self.folder / "names.dbc")
        (self.folder / "plant.json").write_text(json.dumps(plant(*SENT, dbc="names.dbc")))
        subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "out", "--depfile", "plant.d", "--depfile-target", "x"],
                       cwd=self.folder, check=True, capture_output=True)
        self.assertIn("names.dbc", (self.folder / "plant.d").read_text())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
