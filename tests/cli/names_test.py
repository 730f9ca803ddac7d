#!/usr/bin/env python3
"""One name for one thing: the forms of the names of an object in each output and in each look-up.

    names_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import sys
import unittest

from cli_test import FINE, SOURCE_DIR, CommandLine

COUNT = "ParameterName=Highest sub-index supported\nObjectType=7\nDataType=5\nAccessType=const\nDefaultValue={}\n"
MAPPED = (0x20000010, 0x20010010, 0x20020108, 0x20020208, 0x20030108)


def var(section: str, name: str, data_type: int, access: str, value: object = "", mapped: int = 0) -> str:
    return (f"[{section}]\nParameterName={name}\nObjectType=7\nDataType={data_type}\nAccessType={access}\n"
            f"DefaultValue={value}\nPDOMapping={mapped}\n")


def group(index: str, name: str, kind: int, entries: list[str]) -> str:
    return (f"[{index}]\nParameterName={name}\nObjectType={kind}\nSubNumber={len(entries) + 1}\n"
            f"[{index}sub0]\n{COUNT.format(len(entries))}" + "".join(entries))


def listed(section: str, *indices: str) -> str:
    rows = "".join(f"{i}=0x{index}\n" for i, index in enumerate(indices, 1))
    return f"[{section}]\nSupportedObjects={len(indices)}\n{rows}"


EDS = "".join((
    "[FileInfo]\nFileName=tank.eds\n[DeviceInfo]\nVendorName=x\nProductName=tank\nBaudRate_125=1\nGranularity=8\n",
    listed("MandatoryObjects", "1000", "1001", "1018"),
    var("1000", "Device type", 7, "ro", 0),
    var("1001", "Error register", 5, "ro"),
    group("1018", "Identity object", 9, [var("1018sub1", "Vendor-ID", 7, "ro", 1)]),
    listed("OptionalObjects", "1017", "1800", "1A00"),
    var("1017", "Producer heartbeat time", 6, "rw", 0),
    group("1800", "TPDO communication parameter", 9, [
        var("1800sub1", "COB-ID", 7, "rw", "$NODEID+0x180"), var("1800sub2", "Transmission type", 5, "rw", 255)]),
    group("1A00", "TPDO mapping parameter", 9, [
        var(f"1A00sub{i}", f"Mapped object {i}", 7, "const", hex(value)) for i, value in enumerate(MAPPED, 1)]),
    listed("ManufacturerObjects", "2000", "2001", "2002", "2003"),
    var("2000", "Analogue Input 1", 3, "ro", 0, 1),
    var("2001", "CiA402Level (mV)", 3, "ro", 0, 1),
    group("2002", "Levels", 8, [var(f"2002sub{i}", f"Level {i}", 5, "ro", 0, 1) for i in (1, 2)]),
    group("2003", "Switch", 9, [var("2003sub1", "I2C state", 5, "ro", 0, 1)])))

OPTIONS = {"names": {"2000h:00": "boiler_temperature", "2002h:01": "inner"}}

# Entry; DBC and C; C++; dump, of the object and of the entry; in texts; what the EDS calls it.
FORMS = (
    ("2000h:00", "boiler_temperature", "od::boiler_temperature", ("boiler_temperature", "boiler_temperature"),
     "boiler_temperature", "Analogue Input 1"),
    ("2001h:00", "cia402level_mv", "od::cia402level_mv", ("cia402level_mv", "cia402level_mv"),
     "CiA402Level (mV)", "CiA402Level (mV)"),
    ("2002h:01", "levels_inner", "od::levels_inner", ("levels", "inner"), "Levels, inner", "Levels.Level 1"),
    ("2002h:02", "levels_2", "od::levels<2>", ("levels", "level_2"), "Levels, Level 2", "Levels.Level 2"),
    ("2003h:01", "switch_i2c_state", "od::switch_::i2c_state", ("switch", "i2c_state"), "Switch, I2C state",
     "Switch.I2C state"),
)


class Forms(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.eds = self.write("tank.eds", EDS)
        self.write("tank.options.json", json.dumps(OPTIONS))

    def printed(self, *arguments: object) -> str:
        result = self.edsc(*arguments)
        self.assertEqual(result.returncode, FINE, result.stderr)
        return result.stdout

    def read(self, name: str) -> str:
        return (self.eds.parent / name).read_text(encoding="cp1252")

    def test_of_generated_files(self) -> None:
        self.printed("generate", self.eds, "--node-id", 3, "-o", self.eds.parent, "--dbc", self.eds.parent / "tank.dbc")
        self.printed("generate", self.eds, "--target", "c", "-o", self.eds.parent / "c")
        dbc, pdo, in_c = self.read("tank.dbc"), self.read("tank/pdo.hpp"), self.read("c/tank/objects.h")
        for _, name, in_cpp, _, _, title in FORMS:
            self.assertIn(f" SG_ {name} : ", dbc)
            self.assertIn(title.rpartition(".")[2] + '"', dbc)
            self.assertRegex(pdo, rf"[<( ]{in_cpp}[,>]")
            self.assertIn(f"tank_{name}", in_c.lower())

    def test_of_a_dump(self) -> None:
        device = json.loads(self.printed("dump", self.eds))
        named = {f"{entry['index']:04X}h:{entry['sub_index']:02X}": (one["identifier"], entry["identifier"])
                 for one in device["objects"] for entry in one["entries"]}
        for label, _, _, identifiers, _, _ in FORMS:
            self.assertEqual(named[label], identifiers)

    def test_of_a_network(self) -> None:
        signals = [{"from": "tank", "object": name, "to": "plc", "event": True} for _, name, *_ in FORMS]
        nodes = {"plc": {"node_id": 127, "master": True, "heartbeat_ms": 100},
                 "tank": {"node_id": 3, "eds": "tank.eds", "heartbeat_ms": 100}}
        self.write("line.json", json.dumps({"bit_rate": 125, "nodes": nodes, "signals": signals}))
        self.printed("network", "generate", self.eds.parent / "line.json", "-o", self.eds.parent / "made")
        dbc, plant, master = (self.read(f"made/{name}") for name in ("line.dbc", "line.hpp", "plc.eds"))
        for _, name, _, _, _, title in FORMS:
            self.assertIn(f" SG_ {name} : ", dbc)
            self.assertIn(f"struct {name} ", plant)
            self.assertRegex(master, rf"(?m)^ParameterName=({name}|{title.replace('(', '.').replace(')', '.')})$")

    def test_of_a_page(self) -> None:
        page = self.printed("document", self.eds)
        for _, _, in_cpp, _, text, _ in FORMS:
            self.assertIn(in_cpp.replace("<", "&lt;").replace(">", "&gt;").rpartition("::")[2], page)
            self.assertIn(text.rpartition(", ")[2], page)

    def test_of_texts_and_look_ups(self) -> None:
        log = self.write("tank.log", "(1.000000) can0 183#01000200030405\n(2.000000) can0 183#01000200030406\n")
        node = ("--node", f"3={self.eds}")
        decoded = self.printed("decode", log, *node)
        for number, (label, name, in_cpp, _, text, title) in enumerate(FORMS, 1):
            self.assertIn(f"{text} = {number}", decoded)
            pictures = {self.printed("plot", log, one, *node) for one in (label, name, in_cpp, title)}
            self.assertEqual(len(pictures), 1, name)

    def test_of_messages(self) -> None:
        self.assertIn("boiler_temperature", self.edsc("plot", self.write("x.log", ""), "boiler_temperatur", "--node",
                                                      f"3={self.eds}").stderr)


if __name__ == "__main__":
    assert SOURCE_DIR
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
