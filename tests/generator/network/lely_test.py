#!/usr/bin/env python3
"""The files of edsc network generate --target lely, read by PyYAML and configparser: the values of bus.yml, packed as dcfgen packs
them, are the concise DCF; the DCF of the master has what Lely's loader requires.

    lely_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import configparser
import json
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import yaml

SOURCE_DIR, EDSC = (Path(argument).resolve() for argument in sys.argv[1:3])
PLANT = {
    "bit_rate": 500, "sync": {"producer": "control", "period_us": 10000, "window_us": 3000},
    "nodes": {
        "control": {"node_id": 127, "master": True, "heartbeat_ms": 100},
        "a": {"node_id": 1, "eds": "node.eds", "heartbeat_ms": 50, "master_timeout_ms": 300, "set": {"ramp": 250, "2007h": -7}},
        "Pump 2": {"node_id": 2, "eds": "node.eds", "heartbeat_ms": 70, "heartbeat_timeout_ms": 100, "serial_number": 4711},
        "master": {"node_id": 3, "eds": "node.eds"},
    },
    "signals": [
        {"from": "a", "object": "position", "to": ["Pump 2.target_position", "control"], "every_ms": 10},
        {"from": "control", "object": "a.target_position", "every_sync": 1},
    ],
}
FORMATS = {0x0001: "<B", 0x0002: "<b", 0x0003: "<h", 0x0004: "<i", 0x0005: "<B", 0x0006: "<H", 0x0007: "<I"}  # by data type


def sheet(path: Path) -> configparser.RawConfigParser:
    file = configparser.RawConfigParser(strict=True, comment_prefixes=(";",), delimiters=("=",))
    file.read_string(path.read_text(encoding="utf-8"))
    return file


class Lely(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-lely-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(SOURCE_DIR / "tests/generator/network/node.eds", self.folder)
        self.out = self.folder / "out"

    def generate(self, plant: dict = PLANT, *arguments: object, exit_code: int = 0) -> str:
        (self.folder / "plant.json").write_text(json.dumps(plant))
        result = subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "out", "--target", "lely", *arguments],
                                cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result.stderr

    def bus(self) -> dict:
        return yaml.safe_load((self.out / "bus.yml").read_text(encoding="utf-8"))

    def test_the_values_of_a_node_are_its_concise_dcf(self) -> None:
        self.generate()
        types = sheet(self.folder / "node.eds")
        for key, name in (("a", "a"), ("pump_2", "Pump 2")):
            packed = b""
            rows = self.bus()[key]["sdo"]
            for row in rows:
                section = f"{row['index']:04X}"
                if not types.has_option(section, "DataType"):
                    section += f"sub{row['sub_index']:X}"
                data = struct.pack(FORMATS[int(types[section]["DataType"], 0)], row["value"])
                packed += struct.pack("<HBI", row["index"], row["sub_index"], len(data)) + data
            self.assertGreater(len(rows), 5)
            self.assertEqual(struct.pack("<I", len(rows)) + packed, (self.out / f"{name}.cdcf").read_bytes())
        self.assertIn({"index": 0x2007, "sub_index": 0, "value": -7}, self.bus()["a"]["sdo"])

    def test_the_members_of_master_and_nodes(self) -> None:
        self.generate()
        bus = self.bus()
        self.assertEqual(list(bus), ["master", "a", "pump_2", "master_3"])
        self.assertEqual(bus["master"], {
            "node_id": 127, "baudrate": 500, "driver": "ros2_canopen::MasterDriver", "package": "canopen_master_driver",
            "heartbeat_producer": 100, "sync_period": 10000, "sync_window": 3000, "error_behavior": {1: 1}})
        for name, members in (("a", {"dcf": "a.dcf", "node_id": 1, "heartbeat_multiplier": 2}),
                              ("pump_2", {"dcf": "Pump 2.dcf", "node_id": 2, "serial_number": 4711})):
            self.assertEqual({key: bus[name][key] for key in members}, members)
        self.assertEqual(int(bus["pump_2"]["heartbeat_multiplier"] * 70), 100)
        self.assertEqual(bus["a"]["driver"], "ros2_canopen::ProxyDriver")

    def test_no_file_is_that_of_dcfgen(self) -> None:
        self.generate()
        self.assertEqual(self.bus()["master_3"]["dcf"], "master_3.dcf")
        self.generate({"bit_rate": 500, "nodes": {"Master": {"node_id": 127, "master": True}, "a": {"node_id": 1, "eds": "node.eds"}}})
        self.assertEqual(sheet(self.out / "master_127.dcf")["1F22sub1"]["UploadFile"], "a.cdcf")
        self.assertEqual(sheet(self.out / "master_127.dcf")["FileInfo"]["FileName"], "master_127.dcf")
        self.assertFalse((self.out / "Master.dcf").exists())

    def test_names_with_a_meaning_in_yaml_and_dcfgen(self) -> None:
        names = ("on", "null", "y", "defaults", "options")
        self.generate({"bit_rate": 500, "nodes": {
            "control": {"node_id": 127, "master": True},
            **{name: {"node_id": node_id, "eds": "node.eds"} for node_id, name in enumerate(names, 1)}}})
        self.assertEqual(list(self.bus()), ["master", "on", "null", "y", "defaults_4", "options_5"])

    def test_a_drive_has_the_driver_for_drives(self) -> None:
        for file in (SOURCE_DIR / "eds").glob("ezd-1136.*"):
            shutil.copy(file, self.folder)
        self.generate({"bit_rate": 500, "nodes": {"control": {"node_id": 127, "master": True},
                                                  "axis": {"node_id": 1, "eds": "ezd-1136.eds"}}})
        self.assertEqual([self.bus()["axis"][key] for key in ("driver", "package")],
                         ["ros2_canopen::Cia402Driver", "canopen_402_driver"])

    def test_the_dcf_of_the_master(self) -> None:
        self.generate()
        master = sheet(self.out / "control.dcf")
        for node_id, file in ((1, "a.cdcf"), (2, "Pump 2.cdcf"), (3, "master.cdcf")):
            entry = master[f"1F22sub{node_id}"]
            self.assertEqual((entry["UploadFile"], entry["AccessType"]), (file, "ro"))
            self.assertNotIn("DownloadFile", entry)
        self.assertEqual([name for name in master.sections() if name.startswith(("128", "12F"))], [])
        listed = set()
        for name in ("MandatoryObjects", "OptionalObjects", "ManufacturerObjects"):
            count = int(master[name]["SupportedObjects"])
            self.assertEqual(sorted(master[name]), sorted([*map(str, range(1, count + 1)), "supportedobjects"]))
            listed |= {int(master[name][str(i)], 0) for i in range(1, count + 1)}
        objects = {int(name, 16) for name in master.sections() if len(name) == 4}
        self.assertEqual(listed, objects)

    def test_without_the_option_the_dcf_of_the_master_is_for_other_tools(self) -> None:
        (self.folder / "plant.json").write_text(json.dumps(PLANT))
        subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "out"], cwd=self.folder, check=True, capture_output=True)
        self.assertFalse((self.out / "bus.yml").exists())
        master = sheet(self.out / "control.dcf")
        self.assertEqual(master["1F22sub1"]["DownloadFile"], "a.cdcf")
        self.assertIn("1280", master.sections())

    def test_a_value_that_is_not_an_integer_is_reported(self) -> None:
        text = (self.folder / "node.eds").read_text(encoding="utf-8")
        before, section, after = text.partition("[2006]")
        (self.folder / "node.eds").write_text(before + section + after.replace("DataType=0x0006", "DataType=0x0008", 1),
                                              encoding="utf-8")
        plant = {"bit_rate": 500, "nodes": {"control": {"node_id": 127, "master": True},
                                            "a": {"node_id": 1, "eds": "node.eds", "set": {"2006h": "0x3F000000"}}}}
        self.assertIn('edsc: not in bus.yml: a: 2006h:00 "Ramp" (REAL32)\n', self.generate(plant))
        self.assertNotIn("sdo", self.bus()["a"])

    def test_a_network_without_a_master(self) -> None:
        plant = {"bit_rate": 500, "nodes": {"a": {"node_id": 1, "eds": "node.eds"}}}
        self.assertIn('the files for Lely need a node with "master": true [network-file]', self.generate(plant, exit_code=1))
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
