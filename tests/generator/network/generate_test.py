#!/usr/bin/env python3
"""edsc network generate, with expectations worked out by hand and with readers that are not edsc's: configparser for the values
of the DCFs, npm's canopen as a tool that loads them, npm's candied for the DBC file,
ElementTree for the drawings, the compiler for the headers.

    generate_test.py SOURCE_DIR EDSC CANDIED_WORK_DIR CANOPEN_WORK_DIR [unittest arguments]
"""

from __future__ import annotations

import configparser
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
CANDIED, CANOPEN = Path(sys.argv[3]).resolve(), Path(sys.argv[4]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from npm_packages import Skipped, install_npm_packages  # noqa: E402

SVG = {"svg": "http://www.w3.org/2000/svg"}
PLANT = """{
  "bit_rate": 500, "length_m": 40,
  "sync": {"producer": "master", "period_us": 10000},
  "nodes": {
    "master": {"node_id": 127, "master": true, "heartbeat_ms": 100},
    "a": {"node_id": 1, "eds": "node.eds", "heartbeat_ms": 50, "set": {"ramp": 250}},
    "b": {"node_id": 2, "eds": "node.eds", "heartbeat_ms": 50, "serial_number": 4711}
  },
  "signals": [
    {"from": "a", "object": "position", "to": ["b.target_position", "master"], "every_ms": 10},
    {"from": "a", "object": "speed", "to": ["b.target_speed", "master"], "every_ms": 10},
    {"from": "master", "object": "a.target_position", "every_sync": 1}
  ]
}
"""
TINY = """{
  "bit_rate": 500,
  "nodes": {"a": {"node_id": 1, "eds": "node.eds"}, "b": {"node_id": 2, "eds": "node.eds", "set": {"ramp": 250}}},
  "signals": [{"from": "a", "object": "speed", "to": "b.target_speed", "every_ms": 10}]
}
"""
LOAD = """const {Eds} = require("canopen");
const found = {};
for (const file of process.argv.slice(1)) {
  const eds = Eds.fromFile(file);
  found[file.split("/").pop()] = [eds.getEntry(0x1017).dataType, eds.getEntry(0x1A00).subNumber];
}
console.log(JSON.stringify(found));"""


def parameter_values(path: Path) -> dict[str, int]:
    file = configparser.RawConfigParser(strict=True, comment_prefixes=(";",), delimiters=("=",))
    file.read_string(path.read_text())
    return {section.upper().replace("SUB", ":"): int(file[section]["ParameterValue"], 0) for section in file.sections()
            if re.match("[0-9A-Fa-f]{4}", section) and "ParameterValue" in file[section]}


class Generate(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-network-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(SOURCE_DIR / "tests/generator/network/node.eds", self.folder)
        self.out = self.folder / "out"

    def edsc(self, *arguments: object, exit_code: int = 0) -> subprocess.CompletedProcess[str]:
        result = subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result

    def generate(self, text: str = PLANT, *arguments: object, exit_code: int = 0) -> subprocess.CompletedProcess[str]:
        (self.folder / "plant.json").write_text(text)
        return self.edsc("network", "generate", "plant.json", "-o", "out", *arguments, exit_code=exit_code)

    def npm(self, source: str, work: Path) -> None:
        try:
            install_npm_packages(SOURCE_DIR / source, work)
        except Skipped as reason:
            self.skipTest(str(reason))

    def test_the_files(self) -> None:
        self.generate()
        self.assertEqual(sorted(path.name for path in self.out.iterdir()),
                         [".edsc-files", "a.cdcf", "a.dcf", "b.cdcf", "b.dcf", "master", "master.cdcf", "master.dcf", "master.eds",
                          "network-devices.hpp", "node", "plant.dbc", "plant.dot", "plant.hpp", "plant.svg", "plant_cycle.svg"])
        for device in ("master", "node"):
            self.assertEqual(sorted(path.name for path in (self.out / device).iterdir()),
                             ["description.hpp", "device.hpp", "dictionary.hpp", "meaning.hpp", "meaning_text.hpp", "pdo.hpp"])

    def contents(self) -> dict[str, bytes]:
        return {str(path.relative_to(self.out)): path.read_bytes() for path in self.out.rglob("*") if path.is_file()}

    def test_a_file_of_others_is_not_replaced(self) -> None:
        for name in ("master.eds", "a.dcf", "a.cdcf", "plant.dbc", "plant.dot", "plant.svg", "plant.hpp", "node/device.hpp"):
            with self.subTest(name):
                shutil.rmtree(self.out, ignore_errors=True)
                path = self.out / name
                path.parent.mkdir(parents=True)
                path.write_text("written by hand\n")
                self.assertIn(f"out/{name}: edsc has not written this file", self.generate(exit_code=2).stderr)
                self.assertEqual(self.contents(), {name: b"written by hand\n"})
                checked = self.generate(PLANT, "--check", exit_code=1).stdout
                self.assertIn(f"out/{name}: would be replaced by --force", checked)
                self.assertEqual(self.contents(), {name: b"written by hand\n"})
                self.generate(PLANT, "--force")
                self.assertNotEqual(path.read_bytes(), b"written by hand\n")
                self.generate(PLANT)

    def test_a_file_that_was_changed_since_is_not_replaced(self) -> None:
        self.generate()
        changed = self.out / "a.dcf"
        changed.write_text(changed.read_text() + "; a remark of mine\n")
        before = self.contents()
        self.assertIn("out/a.dcf: edsc has not written this file, or it was changed since", self.generate(exit_code=2).stderr)
        self.assertEqual(self.contents(), before)
        self.generate(PLANT, "--force")
        self.assertNotIn("remark of mine", changed.read_text())
        self.generate()

    def test_check_writes_nothing(self) -> None:
        self.assertIn("out/a.dcf: would be created", self.generate(PLANT, "--check", exit_code=1).stdout)
        self.assertFalse(self.out.exists())
        self.generate()
        before = self.contents()
        self.assertEqual(self.generate(PLANT, "--check").stdout, "")
        (self.out / "b.dcf").unlink()
        self.assertEqual(self.generate(PLANT, "--check", exit_code=1).stdout, "out/b.dcf: would be created\n")
        (self.out / "b.dcf").write_bytes(before["b.dcf"])
        other = PLANT.replace('"a": {"node_id": 1', '"a": {"node_id": 11')
        self.assertNotEqual(other, PLANT)
        shown = self.generate(other, "--check", exit_code=1).stdout
        self.assertIn("out/a.dcf: would be replaced\n", shown)
        self.assertEqual(self.contents(), before)
        self.generate(other)
        changed = {name for name, content in self.contents().items() if content != before.get(name)} - {".edsc-files"}
        self.assertEqual(set(re.findall(r"^out/(\S+): would be ", shown, re.MULTILINE)), changed)

    def test_a_dcf_has_the_values_of_the_network_file_and_a_mapping_as_a_whole(self) -> None:
        self.generate()
        self.assertEqual(parameter_values(self.out / "a.dcf"), {
            "1017": 50, "2006": 250,
            "1400:1": 0x201, "1400:2": 1,
            "1600:0": 1, "1600:1": 0x20030020, "1600:2": 0x20030020, "1600:3": 0, "1600:4": 0,
            "1800:1": 0x40000181, "1800:5": 10,
            "1A00:0": 2, "1A00:1": 0x20010020, "1A00:2": 0x20000010, "1A00:3": 0, "1A00:4": 0})
        self.assertEqual(parameter_values(self.out / "b.dcf"), {
            "1017": 50, "1400:1": 0x181,
            "1600:0": 2, "1600:1": 0x20030020, "1600:2": 0x20020010, "1600:3": 0, "1600:4": 0})
        master = parameter_values(self.out / "master.dcf")
        self.assertEqual({entry: master[entry] for entry in ("1005", "1006", "1017", "1400:1", "1800:1", "1800:2")},
                         {"1005": 0x40000080, "1006": 10000, "1017": 100, "1400:1": 0x181, "1800:1": 0x201, "1800:2": 1})

    def test_values_with_units_and_names(self) -> None:
        """001 has 6081h in 0.01 rev/s and 6083h in rev/s2. The scale of 6081h of the other drive is that of `set`."""
        for file in (SOURCE_DIR / "eds").glob("ezd-1136.*"):
            shutil.copy(file, self.folder)
        self.generate(json.dumps({"bit_rate": 500, "nodes": {
            "master": {"node_id": 127, "master": True, "heartbeat_ms": 100},
            "a": {"node_id": 1, "eds": "ezd-1136.eds", "heartbeat_ms": 100, "master_timeout_ms": 250,
                  "set": {"6060h": "profile_velocity", "6081h": "12.5 rev/s", "6083h": "2000 rev/s2", "6084h": 300}},
        }}))
        values = parameter_values(self.out / "a.dcf")
        self.assertEqual({key: values[key] for key in ("6060", "6081", "6083", "6084", "1016:1")},
                         {"6060": 3, "6081": 1250, "6083": 2000, "6084": 300, "1016:1": 127 << 16 | 250})

    def test_unused_pdos_are_disabled_on_request(self) -> None:
        """TPDO 2 of all nodes sends on 280h + node-ID; c receives that of a. A signal uses TPDO 1 of a, `set` states TPDO 2 of c."""
        text = (self.folder / "node.eds").read_text()
        (self.folder / "node.eds").write_text(re.sub(r"(\[1801sub1\][^\[]*DefaultValue=)\S*", r"\g<1>$NODEID+0x40000280", text))
        plant = json.loads(TINY)
        plant["nodes"]["c"] = {"node_id": 3, "eds": "node.eds", "set": {"1401h:01": "0x281", "1801h:01": "0x40000290"}}
        used = {"a": None, "b": None, "c": 0x40000290}
        for members, expected in (({}, used), ({"disable_unused_pdos": False}, used),
                                  ({"disable_unused_pdos": True}, used | {"b": 0xC0000282})):
            self.generate(json.dumps({**plant, **members}))
            found = {name: parameter_values(self.out / f"{name}.dcf") for name in "abc"}
            self.assertEqual({name: values.get("1801:1") for name, values in found.items()}, expected)
            self.assertEqual(found["a"]["1800:1"], 0x40000181)

    def test_a_dcf_commissions_its_node(self) -> None:
        self.generate()
        for name, node_id, manager in (("a", 1, 0), ("b", 2, 0), ("master", 127, 1)):
            text = (self.out / f"{name}.dcf").read_text()
            serial = "LSS_SerialNumber=4711\n" if name == "b" else ""
            self.assertIn(f"[DeviceComissioning]\nNodeID={node_id}\nNodeName={name}\nBaudrate=500\nNetNumber=0\n"
                          f"NetworkName=plant\nCANopenManager={manager}\n{serial}\n", text)
            self.assertIn(f"FileName={name}.dcf\n", text)

    def test_check_has_no_findings(self) -> None:
        self.generate()
        result = self.edsc("check", "--strict", *self.out.glob("*.dcf"), *self.out.glob("*.eds"))
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_npm_canopen_loads_the_files(self) -> None:
        self.npm("tests/masters/node_canopen", CANOPEN)
        self.generate()
        result = subprocess.run(["node", "-e", LOAD, *self.out.glob("*.dcf"), self.out / "master.eds"], cwd=CANOPEN,
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads(result.stdout), {"a.dcf": [6, 5], "b.dcf": [6, 5], "master.dcf": [6, 9], "master.eds": [6, 9]})

    def test_the_bytes_of_a_concise_dcf(self) -> None:
        self.generate(TINY)
        pieces = ("06000000"
                  "0620 00 02000000 FA00"        # ramp 250
                  "0014 01 04000000 02020080"    # RPDO 1 disabled, CAN-ID 202h as by default
                  "0016 00 01000000 00"
                  "0016 01 04000000 10000220"    # 2002h:00, 16 bits
                  "0016 00 01000000 01"
                  "0014 01 04000000 81010000")   # CAN-ID 181h
        self.assertEqual((self.out / "b.cdcf").read_bytes().hex().upper(), pieces.replace(" ", ""))

    def test_the_concise_dcf_is_that_of_the_dcf(self) -> None:
        self.generate()
        for name in ("a", "b", "master"):
            self.edsc("format", self.out / f"{name}.dcf", "--concise", "-o", "concise")
            self.assertEqual((self.folder / "concise").read_bytes(), (self.out / f"{name}.cdcf").read_bytes())

    def test_the_master_knows_its_slaves(self) -> None:
        self.generate()
        file = configparser.RawConfigParser(comment_prefixes=(";",), delimiters=("=",))
        file.read(self.out / "master.dcf")
        for entry, value in (("1F81sub1", 5), ("1F81sub2", 5), ("1F84sub1", 0), ("1F85sub1", 1), ("1F86sub2", 2),
                             ("1F87sub1", 0x10003), ("1F88sub1", 0), ("1F88sub2", 4711), ("1016sub1", 0x010064)):
            self.assertEqual(int(file[entry]["DefaultValue"], 0), value, entry)
        self.assertEqual([file[f"1F22sub{i}"]["DownloadFile"] for i in (1, 2)], ["a.cdcf", "b.cdcf"])
        for extension in ("eds", "dcf"):
            self.edsc("generate", self.out / f"master.{extension}", "-o", "headers")

    def test_a_value_of_the_master_begins_with_that_of_the_node(self) -> None:
        """Of node.eds and `set`; a value that the master receives begins with 0."""
        text = (self.folder / "node.eds").read_text()
        for section, value in (("2002", "0x10"), ("2003", "-7")):
            text = re.sub(rf"(\[{section}\][^\[]*DefaultValue=)\S*", rf"\g<1>{value}", text)
        (self.folder / "node.eds").write_text(text)
        self.generate(json.dumps({
            "bit_rate": 500, "nodes": {
                "master": {"node_id": 127, "master": True}, "a": {"node_id": 1, "eds": "node.eds"},
                "b": {"node_id": 2, "eds": "node.eds", "set": {"2003h": -9}}},
            "signals": [{"from": "master", "object": f"{node}.{entry}", "event": True} for node in "ab" for entry in ("2002h", "2003h")]
            + [{"from": "a", "object": "2000h", "to": "master", "event": True}]}))
        file = configparser.RawConfigParser(strict=True, comment_prefixes=(";",), delimiters=("=",))
        file.read_string((self.out / "master.eds").read_text())
        self.assertEqual({section: int(file[section]["DefaultValue"], 0)
                          for section in ("2101sub1", "2101sub2", "2102sub1", "2102sub2", "2001sub1")},
                         {"2101sub1": 16, "2101sub2": -7, "2102sub1": 16, "2102sub2": -9, "2001sub1": 0})

    def test_a_node_is_not_hidden_by_a_member_of_the_plant(self) -> None:
        names = ["axis", "count", "device", "on_fault", "plant", "request", "state"]
        nodes = {"m": {"node_id": 127, "master": True},
                 **{name: {"node_id": i, "eds": "node.eds"} for i, name in enumerate(names, 1)}}
        self.generate(json.dumps({"bit_rate": 500, "nodes": nodes}))
        self.assertEqual(re.findall(r"^    \w+Node<Plant> (\w+);", (self.out / "plant.hpp").read_text(), re.MULTILINE),
                         ["axis", "count_2", "device_3", "on_fault_4", "plant_5", "request_6", "state_7"])

    def test_a_node_without_a_heartbeat_is_guarded(self) -> None:
        self.generate(TINY.replace('"nodes": {', '"nodes": {"m": {"node_id": 127, "master": true}, ')
                      .replace('"ramp": 250', '"100Ch": 100, "100Dh": 3'))
        file = configparser.RawConfigParser(comment_prefixes=(";",), delimiters=("=",))
        file.read(self.out / "m.dcf")
        self.assertEqual([int(file[f"1F81sub{i}"]["DefaultValue"], 0) for i in (1, 2)], [0x5, 0x0064_0305])
        header = (self.out / "plant.hpp").read_text()
        self.assertEqual(re.findall(r"\.assignment = (\w+)", header), ["0x5", "0x640305"])

    def test_a_mapping_that_cannot_be_changed_is_not_written(self) -> None:
        text = (self.folder / "node.eds").read_text()
        for index in ("1600", "1A00"):
            entries = re.findall(rf"\[{index}sub[12]\][^\[]*DefaultValue=(\w+)", text)
            text = re.sub(rf"\[{index}\].*?(?=\[1800\]|\[1401\])",
                          f"[{index}]\nParameterName=Mapping\nObjectType=0x9\nDataType=0x0007\nAccessType=rw\n"
                          f"CompactSubObj=2\n\n[{index}Value]\nNrOfEntries=2\n1={entries[0]}\n2={entries[1]}\n\n",
                          text, flags=re.DOTALL)
        (self.folder / "node.eds").write_text(text)
        self.generate(TINY)
        written = (self.out / "b.cdcf").read_bytes()
        self.assertIn(bytes.fromhex("0620 00 02000000 FA00"), written)
        self.assertNotIn(bytes.fromhex("0016 01"), written)
        refused = self.generate(TINY.replace('"ramp": 250', '"1600h:01": "0x20030020"'), exit_code=1)
        self.assertIn("1600h:01", refused.stdout + refused.stderr)
        self.assertIn("sub-index 0 of the mapping cannot be written [network-value]", refused.stdout + refused.stderr)

    def test_a_master_with_a_file_refers_to_the_concise_dcfs(self) -> None:
        self.generate()
        shutil.copy(self.out / "master.eds", self.folder / "control.eds")
        self.generate(PLANT.replace('"master": true', '"eds": "control.eds", "master": true').split('"signals"')[0]
                      .rstrip().rstrip(",") + "\n}\n")
        self.assertEqual((self.out / "master.dcf").read_text().count("DownloadFile="), 2)

    def test_the_dcf_of_a_node_keeps_its_values(self) -> None:
        self.edsc("format", "node.eds", "--dcf", "--node-id", 1, "-o", "axis.dcf")
        text = (self.folder / "axis.dcf").read_text()
        for section, value in (("2007", 7), ("1007", 9)):
            text = re.sub(rf"(\[{section}\][^\[]*?)(\n\n)", rf"\g<1>\nParameterValue={value}\2", text, count=1)
        (self.folder / "axis.dcf").write_text(text)
        self.generate(TINY.replace('"node_id": 1, "eds": "node.eds"', '"dcf": "axis.dcf", "set": {"1007h": 8}'))
        values = parameter_values(self.out / "a.dcf")
        self.assertEqual({entry: values[entry] for entry in ("2007", "1007")}, {"2007": 7, "1007": 8})

    def test_candied_reads_senders_and_receivers(self) -> None:
        self.npm("tests/generator/backend/candied", CANDIED)
        result = self.generate()
        output = subprocess.run(["node", CANDIED / "read_dbc.js", self.out / "plant.dbc"], check=True, capture_output=True,
                                text=True).stdout
        found = {message["id"]: (message["sendingNode"], message["dlc"],
                                 {signal["name"]: (signal["startBit"], signal["length"], signal["receivingNodes"])
                                  for signal in message["signals"].values()})
                 for message in json.loads(output)[str(self.out / "plant.dbc")]}
        self.assertEqual(found, {
            0x181: ("a", 6, {"position": (0, 32, ["master", "b"]), "speed": (32, 16, ["master", "b"])}),
            0x201: ("master", 4, {"a_commands_target_position": (0, 32, ["a"])})})
        self.assertIn("edsc: not in the DBC file: a RPDO 2: disabled by default\n", result.stderr)

    def test_the_graph_has_an_arrow_for_each_link(self) -> None:
        self.generate()
        self.assertEqual(re.findall(r'"(\w+)" -> "(\w+)" \[label="(.*?)\\n', (self.out / "plant.dot").read_text()),
                         [("master", "a", "TPDO 1 to RPDO 1, 201h"), ("a", "master", "TPDO 1 to RPDO 1, 181h"),
                          ("a", "b", "TPDO 1 to RPDO 1, 181h")])

    def svg(self, name: str) -> ElementTree.Element:
        """Of a drawing whose colours do not depend on variables, for light and dark."""
        root = ElementTree.parse(self.out / name).getroot()
        style = root.findtext("svg:style", "", SVG)
        self.assertNotIn("var(", style)
        colors = [re.search(r"\.page \{ fill: (#\w+)", part)[1] for part in style.split("@media (prefers-color-scheme: dark)")]
        self.assertEqual(colors, ["#ffffff", "#14171b"])
        self.assertEqual([child.tag for child in root[:2]], [f"{{{SVG['svg']}}}title", f"{{{SVG['svg']}}}desc"])
        return root

    def test_the_drawing_has_an_arrow_for_each_link(self) -> None:
        self.generate()
        root = self.svg("plant.svg")
        columns = {group.findtext("svg:title", "", SVG): group.find("svg:line", SVG).get("x1")
                   for group in root.findall("svg:g", SVG) if group.find("svg:rect", SVG) is not None}
        self.assertEqual(list(columns), ["master", "a", "b"])
        names = {x: name for name, x in columns.items()}
        arrows = {(row.findtext("svg:text", "", SVG), names[row.find("svg:circle", SVG).get("cx")]):
                  [names[arrow.get("points").split(",")[0]] for arrow in row.findall("svg:polygon", SVG)]
                  for row in root.findall("svg:g", SVG) if row.find("svg:circle", SVG) is not None}
        self.assertEqual(arrows, {("080h SYNC", "master"): ["a", "b"], ("181h TPDO 1", "a"): ["master", "b"],
                                  ("201h TPDO 1", "master"): ["a"]})
        self.assertIn("a TPDO 1 to master RPDO 1, b RPDO 1.", root.findtext("svg:desc", "", SVG))

    def test_the_drawing_of_the_sync_cycle(self) -> None:
        self.generate()
        root = self.svg("plant_cycle.svg")
        rows = [group for group in root.findall("svg:g", SVG) if group.find("svg:rect", SVG) is not None]
        self.assertEqual([row.findtext("svg:text", "", SVG) for row in rows], ["master SYNC", "master TPDO 1"])
        bars = [row.find("svg:rect", SVG) for row in rows]
        # 640 units are 10 ms. Davis et al. 2007: 55 and 95 bits with all stuff bits, 2 us each.
        for bar, begin, length in zip(bars, (0.0, 0.11), (0.11, 0.19)):
            self.assertAlmostEqual(float(bar.get("x")) - 190, begin * 64, delta=0.1)
            self.assertAlmostEqual(float(bar.get("width")), length * 64, delta=0.1)

    def test_a_network_without_pdos_and_sync(self) -> None:
        """Its drawing has the nodes, and characters that XML reserves."""
        (self.folder / "p&l <1>.json").write_text('{"bit_rate": 500, "nodes": {"a": {"node_id": 1, "eds": "node.eds"}}}')
        self.edsc("network", "generate", "p&l <1>.json", "-o", "out")
        root = self.svg("p&l <1>.svg")
        self.assertEqual(root.findtext("svg:title", "", SVG), "p&l <1>")
        self.assertEqual(root.findtext("svg:g/svg:text", "", SVG), "a")
        self.assertEqual(list(self.out.glob("*_cycle.svg")), [])

    def test_the_headers_of_a_device_are_those_of_edsc_generate(self) -> None:
        self.generate()
        self.edsc("generate", "node.eds", "-o", "headers")
        for path in (self.folder / "headers/node").iterdir():
            self.assertEqual((self.out / "node" / path.name).read_text(), path.read_text(), path.name)

    def test_names_in_cpp_differ(self) -> None:
        """A node and a sheet with the name of the network, and two nodes whose names are one name in C++."""
        shutil.copy(self.folder / "node.eds", self.folder / "plant.eds")
        self.generate(PLANT.replace('"a": {"node_id": 1, "eds": "node.eds"', '"b-1": {"node_id": 1, "eds": "plant.eds"')
                      .replace('"a"', '"b-1"').replace('"a.', '"b-1.').replace('"b"', '"b_1"').replace('"b.', '"b_1.'))
        text = (self.out / "plant.hpp").read_text()
        for line in ("namespace b_1 {", "namespace b_1_2 {", "using ::plant_device::Device;", "using ::node::Device;",
                     '{ "b-1", b_1::node_id, 0x81 },', '{ "b_1", b_1_2::node_id, 0x82 },'):
            self.assertIn(line, text)
        self.compile("plant.hpp")

    def test_the_header_of_a_network_without_a_master(self) -> None:
        self.generate(TINY)
        text = (self.out / "plant.hpp").read_text()
        self.assertIn("canopen::LinkedPdos<::plant::a::Tpdo1, ::plant::b::Rpdo1>", text)
        self.assertNotIn("struct Network", text)
        self.compile("plant.hpp")

    def test_the_header_proves_its_links(self) -> None:
        """A CAN-ID, and a mapping, that are changed in the header are not compiled; the message names nodes and objects."""
        self.generate()
        self.compile("plant.hpp")
        header = self.out / "plant.hpp"
        text = header.read_text()
        for old, new, messages in (
                (".cob_id = 0x40000181", ".cob_id = 0x40000182",
                 ("different COB-IDs", "plant::a::Tpdo1, plant::master::Rpdo1", "plant::a::Tpdo1, plant::b::Rpdo1")),
                ("Rpdo<od::target_position, od::target_speed>", "Rpdo<od::target_speed, od::target_position>",
                 ("PDO link: the entry of the TPDO has another length", "plant::a::Tpdo1, plant::b::Rpdo1",
                  "node::od::target_speed", "node::od::position"))):
            self.assertIn(old, text)
            header.write_text(text.replace(old, new, 1))
            found = self.compile("plant.hpp", fails=True)
            for message in messages:
                self.assertIn(message, found)

    def write_options(self, name: str, **options: object) -> None:
        shutil.copy(self.folder / "node.eds", self.folder / f"{name}.eds")
        (self.folder / f"{name}.options.json").write_text(json.dumps(options))

    def run_program(self, text: str) -> str:
        program = self.folder / "program"
        subprocess.run(["c++", "-std=c++20", "-Wall", "-Wextra", "-Werror", "-I", SOURCE_DIR / "runtime/include", "-I", self.out,
                        "-x", "c++", "-", "-o", program], input=text, text=True, check=True)
        return subprocess.run([program], capture_output=True, text=True, check=True).stdout

    def test_an_emcy_has_the_name_of_the_device(self) -> None:
        self.write_options("pump", meaning={"emcy": {"2310h": "motor current", "FF01h": 'door "A" open'}})
        text = PLANT.replace('"a": {"node_id": 1, "eds": "node.eds"', '"a": {"node_id": 1, "eds": "pump.eds"')
        self.generate(text)
        found = self.run_program("""
            #include <canopen_plant/plant_text.hpp>
            #include <plant.hpp>
            int main() {
              for (const canopen::PlantNode& node : plant::Network::nodes) {
                for (const unsigned code : {0x2310U, 0xFF01U, 0x8130U, 0xFF02U}) {
                  canopen::PlantFault fault{};
                  fault.kind = canopen::PlantFaultKind::emergency;
                  fault.emergency.code = static_cast<std::uint16_t>(code);
                  std::puts(fault_text(node, fault, plant::Network::places, plant::Network::errors).c_str());
                }
              }
            }""")
        self.assertEqual(found.splitlines(), [
            "a: EMCY 2310h: motor current", 'a: EMCY FF01h: door "A" open', "a: EMCY 8130h: life guard or heartbeat error",
            "a: EMCY FF02h: device specific", "b: EMCY 2310h: current, device output side", "b: EMCY FF01h: device specific",
            "b: EMCY 8130h: life guard or heartbeat error", "b: EMCY FF02h: device specific"])

    def test_nodes_of_one_file_share_the_names_of_their_error_codes(self) -> None:
        self.write_options("pump", meaning={"emcy": {"FF01h": "door open"}})
        self.generate(PLANT.replace("node.eds", "pump.eds"))
        header = (self.out / "plant.hpp").read_text()
        self.assertEqual(header.count('{ 0xFF01, "door open" }'), 1)
        self.assertEqual(re.findall(r"\{ (\w+)::node_id, (\w+)::error_texts \}", header), [("a", "a"), ("b", "a")])

    UNITS = """{
      "bit_rate": 500, "sync": {"producer": "m", "period_us": 10000},
      "nodes": {"m": {"node_id": 127, "master": true, "eds": "own.eds"},
                "a": {"node_id": 1, "eds": "pump.eds", "heartbeat_ms": 50}},
      "signals": [{"from": "a", "object": "speed", "to": "m.target_speed", "every_ms": 10},
                  {"from": "m", "object": "position", "to": "a.target_position", "every_ms": 10}]
    }"""

    def write_units(self, of_master: dict[str, str]) -> None:
        meaning = {"2000h": {"unit": "V", "scale": "1/100"}, "2003h": {"values": {"0": "home", "1": "away", "-1": "back"}}}
        self.write_options("pump", typed_values=True, meaning=meaning)
        own = self.folder / "own.eds"
        self.write_options("own", typed_values=True, meaning={"2002h": of_master})
        own.write_text(own.read_text().replace("Unit=inc", "Unit="))

    def test_a_signal_has_the_unit_and_names_of_the_node(self) -> None:
        self.write_units({"unit": "mV", "scale": "10"})
        self.generate(self.UNITS)
        header = (self.out / "plant.hpp").read_text()
        self.assertIn('/// 2000h:00 "Speed" UNSIGNED16 in 0.01 V, a TPDO 1 to m RPDO 1', header)
        self.assertRegex(header, r'2003h:00 "Target position" INTEGER32.*, -1 back, 0 home, 1 away')
        found = self.run_program("""
            #include <canopen_plant/plant.hpp>
            #include <cstdio>
            #include <plant.hpp>
            #include <type_traits>
            namespace signals = plant::signals::a;
            static_assert(std::is_same_v<signals::target_position::type, plant::a::od::target_position::type>);
            static_assert(std::is_same_v<signals::speed::type, plant::m::od::target_speed::type>);
            int main() { std::printf("%g\\n", canopen::from_raw<signals::speed::type>(150).in<canopen::unit::volt>()); }""")
        self.assertEqual(found, "1.5\n")

    def test_a_signal_in_another_scale_is_a_warning_and_does_not_compile(self) -> None:
        self.write_units({"unit": "mV"})
        found = self.generate(self.UNITS)
        self.assertRegex(found.stderr + found.stdout, r"m RPDO 1 entry 1, 2002h:00 .* is in mV, but a TPDO 1 sends 2000h:00 .* in 0\.01 V")
        self.assertIn("has another unit, scale or offset", self.compile("plant.hpp", fails=True))

    def compile(self, header: str, fails: bool = False) -> str:
        result = subprocess.run(["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow",
                                 "-Wconversion", "-Wsign-conversion",
                                 "-Werror", "-I", SOURCE_DIR / "runtime/include", "-I", self.out, "-x", "c++", "-"],
                                input=f"#include <{header}>\n", capture_output=True, text=True)
        self.assertEqual(result.returncode != 0, fails, result.stderr)
        return result.stderr

    def test_a_network_with_errors_writes_nothing(self) -> None:
        for text in (TINY.replace('"node_id": 2', '"node_id": 1'), TINY.replace("b.target_speed", "b.ramp"), "{"):
            self.generate(text, "--depfile", "plant.d", exit_code=1)
            self.assertFalse(self.out.exists())
            self.assertFalse((self.folder / "plant.d").exists())
        self.generate(TINY.replace("node.eds", "missing.eds"), exit_code=2)
        self.assertFalse(self.out.exists())

    def test_an_input_is_not_replaced(self) -> None:
        self.generate(TINY)
        before = shutil.copy(self.out / "a.dcf", self.folder / "a.dcf")
        text = Path(before).read_bytes()
        (self.folder / "plant.json").write_text(TINY.replace('"node_id": 1, "eds": "node.eds"', '"dcf": "a.dcf"'))
        self.edsc("network", "generate", "plant.json", "-o", ".", exit_code=2)
        self.assertEqual(Path(before).read_bytes(), text)
        self.assertFalse((self.folder / "b.dcf").exists())

    def test_the_depfile_has_every_input(self) -> None:
        (self.folder / "node.options.json").write_text("{}")
        self.generate(TINY, "--depfile", "plant.d", "--depfile-target", "plant.stamp")
        self.assertEqual((self.folder / "plant.d").read_text(),
                         "plant.stamp: \\\n  plant.json \\\n  node.eds \\\n  node.options.json\n")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]])
