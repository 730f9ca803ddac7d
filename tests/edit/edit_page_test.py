#!/usr/bin/env python3
"""The page of edsc edit in Chromium: what a user does by keyboard alone. `edsc check` and `edsc dump` state the result.

    edit_page_test.py SOURCE_DIR EDSC WORK_DIR [--screenshots FOLDER] [unittest arguments]

npm installs puppeteer-core and axe-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path


def option(name: str) -> str:
    if name not in sys.argv:
        return ""
    at = sys.argv.index(name)
    value = sys.argv[at + 1]
    del sys.argv[at:at + 2]
    return value


SCREENSHOTS = option("--screenshots")
SOURCE_DIR, EDSC, WORK = (Path(argument).resolve() for argument in sys.argv[1:4])
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from browser import CHROMIUM, install_browser  # noqa: E402

OBJECTS = """
[ManufacturerObjects]
SupportedObjects=1
1=0x2000

[2000]
ParameterName=Gains
ObjectType=0x8
SubNumber=4

[2000sub0]
ParameterName=Highest sub-index supported
ObjectType=0x7
DataType=0x0005
AccessType=const
DefaultValue=3
PDOMapping=0

[2000sub1]
ParameterName=Gain 1
ObjectType=0x7
DataType=0x0006
AccessType=rw
DefaultValue=10
PDOMapping=0

[2000sub2]
ParameterName=Gain 2
ObjectType=0x7
DataType=0x0006
AccessType=rw
DefaultValue=20
PDOMapping=0

[2000sub3]
ParameterName=Gain 3
ObjectType=0x7
DataType=0x0006
AccessType=rw
DefaultValue=30
PDOMapping=0
"""


class EditPage(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls) -> None:
        install_browser(SOURCE_DIR, WORK)

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-edit-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = os.environ | {"XDG_STATE_HOME": str(self.folder / "state")}

    def edsc(self, *arguments: object, exit_code: int = 0) -> str:
        result = subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, env=self.environment, capture_output=True, text=True,
                                check=False)
        self.assertEqual(result.returncode, exit_code, result.stdout + result.stderr)
        return result.stdout

    def dump(self, name: str) -> dict:
        return json.loads(self.edsc("dump", name))

    def entries(self, name: str, index: int) -> list[dict]:
        return next(one for one in self.dump(name)["objects"] if one["index"] == index)["entries"]

    def new(self, name: str, *arguments: object) -> Path:
        self.edsc("new", name, "--vendor-name", "Acme", "--vendor", "0x1234", "--product-name", "D1", *arguments)
        return self.folder / name

    def with_gains(self) -> Path:
        path = self.new("drive.eds")
        path.write_text(path.read_text(encoding="utf-8") + OBJECTS, encoding="utf-8")
        self.edsc("check", "--strict", path)
        return path

    def start(self, name: object) -> str:
        """Returns the URL."""
        self.server = subprocess.Popen([EDSC, "edit", str(name), "--no-browser"], cwd=self.folder, env=self.environment, text=True,
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.end, self.server)
        return self.server.stdout.readline().strip()

    @staticmethod
    def end(server: subprocess.Popen) -> None:
        server.kill()
        server.wait()
        server.stdin.close()
        server.stdout.close()

    def browse(self, url: str, story: str, *arguments: object) -> dict:
        browser = subprocess.run(["node", "edit.mjs", CHROMIUM, url, story, *map(str, arguments)], cwd=WORK, capture_output=True, text=True,
                                 check=False)
        self.assertEqual(browser.returncode, 0, browser.stderr)
        found = json.loads(browser.stdout)
        self.assertEqual(found["seen"]["requests"], [])
        # The browser writes an error for each request that a server which has ended does not answer.
        self.assertEqual([one for one in found["seen"]["errors"] if story != "lost" or "Failed to load resource: net::" not in one], [])
        return found

    def test_five_objects_and_two_pdos(self) -> None:
        self.new("drive.eds")
        found = self.browse(self.start("drive.eds"), "make")
        self.assertEqual(found["before"][0], "byte 0 bits 0 to 7, Motor temperature 2000h:00")
        self.assertEqual(found["after"][0], "byte 0 bits 0 to 7, Speed 2001h:00")
        self.assertEqual(found["after"][4], "byte 4 bits 0 to 7, Motor temperature 2000h:00")
        self.assertEqual(found["read"], found["after"][4], "the moved object keeps the focus")
        self.assertIn("+[2003sub4]", found["review"])
        self.edsc("check", "--strict", "drive.eds")
        made = self.dump("drive.eds")
        objects = {one["index"]: one for one in made["objects"]}
        self.assertEqual([(hex(index), objects[index]["name"], objects[index]["object_type"]) for index in range(0x2000, 0x2004)], [
            ("0x2000", "Motor temperature", "VAR"), ("0x2001", "Speed", "VAR"), ("0x2002", "Setpoint", "VAR"), ("0x2003", "Gains", "ARRAY")])
        self.assertIn(0x1010, objects)
        temperature, setpoint, gains = (objects[index]["entries"] for index in (0x2000, 0x2002, 0x2003))
        self.assertEqual((temperature[0]["data_type"], temperature[0]["access"], temperature[0]["pdo_mapping"]), ("INTEGER16", "ro", True))
        self.assertEqual((setpoint[0]["low_limit"], setpoint[0]["high_limit"]), (-1000, 1000))
        self.assertEqual([one["data_type"] for one in gains], ["UNSIGNED8"] + ["UNSIGNED16"] * 4)
        pdos = [(one["direction"], one["number"], one["valid"], [(hex(entry["index"]), entry["offset"]) for entry in one["entries"]])
                for one in made["pdos"]]
        self.assertEqual(sorted(pdos), [("receive", 1, True, [("0x2002", 0)]), ("transmit", 1, True, [("0x2001", 0), ("0x2000", 32)])])
        timer = next(entry for entry in objects[0x1800]["entries"] if entry["sub_index"] == 5)
        self.assertEqual(timer["default_value"], 100)

    def test_cells(self) -> None:
        self.with_gains()
        found = self.browse(self.start("drive.eds"), "cells", "2000h", "Default")
        rejected = found["rejected"]
        self.assertEqual((rejected["cell"], rejected["invalid"]), ("12z", "true"))
        self.assertIn("Default: ", rejected["message"])
        self.assertNotIn("unsaved", rejected["state"], "the file was not touched")

        def defaults(rows: list[list[str]]) -> list[str]:
            return [row[5] for row in rows if row[0][:5] == "2000h" and row[5]]

        self.assertEqual(len(set(defaults(found["several"])[1:])), 1, "three rows have one value")
        self.assertEqual(defaults(found["undone"]), ["3", "10", "20", "30"])
        self.assertEqual(defaults(found["redone"]), defaults(found["several"]))
        self.assertRegex(found["undoName"], "^Undo: ")
        self.assertEqual(found["redoName"].removeprefix("Redo: "), found["undoName"].removeprefix("Undo: "))
        entries = self.entries("drive.eds", 0x2000)
        self.assertEqual([one["default_value"] for one in entries], [3, 100, 100, 100])
        self.assertEqual([one["name"] for one in entries][1:3], ["First", "Second"])

    def test_journal_after_a_crash(self) -> None:
        path = self.with_gains()
        before = path.read_bytes()
        self.browse(self.start("drive.eds"), "leave", "2000h")
        self.server.kill()
        self.server.wait()
        self.assertEqual(path.read_bytes(), before)
        found = self.browse(self.start("drive.eds"), "restore")
        self.assertIn("1 edit was not saved: ", found["offered"][0])
        self.assertIn("Unsaved name", found["offered"][0])
        self.assertTrue(found["isLocked"])
        self.assertEqual(found["after"], [])
        self.assertEqual(next(one for one in self.dump("drive.eds")["objects"] if one["index"] == 0x2000)["name"], "Unsaved name")

    def test_file_changed_by_another_program(self) -> None:
        path = self.with_gains()
        found = self.browse(self.start("drive.eds"), "disk", path, "2000h", "ParameterName=Gain 2", "ParameterName=Their gain",
                            "ParameterName=Gains", "ParameterName=Their gains")
        self.assertIn("Their gain", json.dumps(found["merged"]["rows"]), "the new text of the file")
        self.assertIn("My name", json.dumps(found["merged"]["rows"]), "and the edit")
        self.assertIn("ParameterName=My name", found["conflict"][0])
        self.assertIn("ParameterName=Their gains", found["conflict"][0])
        self.assertIn("ParameterName=Gains", found["conflict"][0])
        made = next(one for one in self.dump("drive.eds")["objects"] if one["index"] == 0x2000)
        self.assertEqual((made["name"], made["entries"][2]["name"]), ("My name", "Their gain"))

    def test_two_pages(self) -> None:
        self.with_gains()
        url = self.start("drive.eds")
        self.server.stdin.write("u\n")
        self.server.stdin.flush()
        second = self.server.stdout.readline().strip()
        self.assertNotEqual(second, url)
        found = self.browse(url, "pair", second, "2000h")
        self.assertNotIn("token", found["address"])
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        self.assertNotIn("unsaved", found["state"], "the second page took the edit back, and a reload shows it")

    def test_hostile_names(self) -> None:
        path = self.with_gains()
        text = path.read_text(encoding="utf-8")
        attack = '<img src=x onerror="globalThis.hacked=1">{{{nonce}}}</script><script>globalThis.hacked=1</script>'
        for before in ("ParameterName=Gains", "ParameterName=Gain 1", "VendorName=Acme", "ProductName=D1", "ParameterName=Device type"):
            self.assertIn(before, text)
            text = text.replace(before, before.split("=")[0] + "=" + attack)
        hostile = self.folder / "a<b>&'.eds"
        hostile.write_text(text, encoding="utf-8")
        found = self.browse(self.start(hostile.name), "hostile")
        self.assertIn(attack, found["names"])
        self.assertEqual((found["images"], found["scripts"], found["isHacked"]), (0, 1, False))
        self.assertIn(hostile.name, found["title"])

    def test_accessibility(self) -> None:
        shutil.copy(SOURCE_DIR / "eds/rk5c.eds", self.folder / "rk5c.eds")
        if SCREENSHOTS:
            Path(SCREENSHOTS).mkdir(parents=True, exist_ok=True)
        self.check_accessibility(self.browse(self.start("rk5c.eds"), "access", *([SCREENSHOTS] if SCREENSHOTS else [])))

    def check_accessibility(self, found: dict) -> None:
        self.assertEqual({view: all_ for view, all_ in found["violations"].items() if all_}, {})
        self.assertEqual({key for key, width in found["overflow"].items() if width > 0}, set(), "400 % zoom needs no horizontal scrolling")
        self.assertEqual(found["focus"], [])
        self.assertEqual(found["moving"], 0)

    def test_lost_server(self) -> None:
        self.with_gains()
        url = self.start("drive.eds")
        found = self.browse(url, "lost", self.server.pid, "2000h")
        self.assertIn("does not answer", found["banners"][0])
        self.assertEqual((found["editors"], found["isLocked"]), (0, True))

    def test_without_javascript(self) -> None:
        self.new("drive.eds")
        found = self.browse(self.start("drive.eds"), "withoutScript")
        self.assertIn("needs JavaScript", found["text"])
        self.assertTrue(found["isVisible"])

    def test_what_does_not_fit(self) -> None:
        self.new("drive.eds")
        for index in (0x2000, 0x2001, 0x2002):
            self.edsc("object", "add", "drive.eds", f"{index:04X}h", f"Value {index:04X}", "UNSIGNED32", "ro", "--mappable")
        self.edsc("object", "map", "drive.eds", "tpdo", 1, "2000h", "2001h")
        found = self.browse(self.start("drive.eds"), "full")
        self.assertIn("does not fit", found["reason"])
        self.assertIn("all 8 bytes", found["reason"])
        self.assertEqual(found["option"], "true")
        self.assertNotIn("unsaved", found["state"])
        self.assertEqual(len(found["after"]), 4, "the four bytes of 2000h")
        self.assertIsNone(found["fits"])

    def test_fix_of_a_finding(self) -> None:
        path = self.with_gains()
        path.write_text(path.read_text(encoding="utf-8").replace("SubNumber=4", "SubNumber=7"), encoding="utf-8")
        found = self.browse(self.start("drive.eds"), "fix")
        self.assertIn("Fix: ", found["name"])
        self.assertNotEqual(found["before"], found["after"])
        self.edsc("check", "--strict", path)

    def test_finding_that_is_allowed(self) -> None:
        path = self.with_gains()
        text = path.read_text(encoding="utf-8").replace("[2000sub1]\n", "[2000sub1]\nUnknownKey=1\n")
        path.write_text(text, encoding="utf-8")
        found = self.browse(self.start("drive.eds"), "reason", "the tool of the vendor needs it")
        self.assertTrue(found["name"].startswith("Allow unknown-key here"), found["name"])
        self.assertIn("reason", found["asked"])
        self.assertNotEqual(found["before"], found["after"])
        comment = "; edsc: allow unknown-key - the tool of the vendor needs it\n"
        self.assertEqual(path.read_text(encoding="utf-8"), text.replace("UnknownKey", f"{comment}UnknownKey"))
        self.edsc("check", "--strict", path)

    def test_values_of_a_dcf(self) -> None:
        self.with_gains()
        self.edsc("format", "drive.eds", "--dcf", "--node-id", 5, "-o", "axis.dcf")
        path = self.folder / "axis.dcf"
        text = path.read_text(encoding="utf-8")
        self.assertEqual(text.count("DefaultValue=30\n"), 1)
        path.write_text(text.replace("DefaultValue=30\n", "DefaultValue=30\nParameterValue=31\n"), encoding="utf-8")
        before = path.read_text(encoding="utf-8").splitlines()
        found = self.browse(self.start("axis.dcf"), "value", "2000h", "77")
        self.assertIn("DCF", found["state"])
        self.assertEqual(found["columns"].index("Value"), found["columns"].index("Default") + 1)
        default, value = (found["columns"].index(name) for name in ("Default", "Value"))
        rows = [next(row for row in found[when] if row[0].startswith("2000h:03")) for when in ("before", "after")]
        self.assertEqual([row[value] for row in rows], ["31", "77"])
        self.assertEqual([row[default] for row in rows], ["30", "30"])
        after = path.read_text(encoding="utf-8").splitlines()
        changed = [pair for pair in zip(before, after, strict=True) if pair[0] != pair[1]]
        self.assertEqual(changed, [("ParameterValue=31", "ParameterValue=77")])

    def test_lines_that_cannot_be_read(self) -> None:
        path = self.with_gains()
        text = path.read_text(encoding="utf-8").replace("[2000sub1]\n", "<<< what is this\n[2000sub1]\n").replace("SubNumber=4", "SubNumber=4\n=")
        path.write_text(text, encoding="utf-8")
        found = self.browse(self.start("drive.eds"), "unreadable", "2000h", "Factors")
        self.assertEqual(found["problems"], [])
        self.assertEqual(len(found["banners"]), 1)
        self.assertIn("2 lines cannot be read and are kept", found["banners"][0])
        self.assertIn("<<< what is this", found["read"])
        self.assertEqual(found["after"], found["banners"])
        self.assertEqual(path.read_text(encoding="utf-8"), text.replace("ParameterName=Gains", "ParameterName=Factors"))

    def test_cell_that_is_applied_anyway(self) -> None:
        path = self.with_gains()
        text = path.read_text(encoding="utf-8")
        found = self.browse(self.start("drive.eds"), "anywayCell", "2000h", "Default", "70000")
        self.assertEqual(found["name"], "Apply anyway: Default of 2000h:03 Gain 3")
        self.assertIn("Default: ", found["message"])
        self.assertNotIn("unsaved", found["state"])
        self.assertEqual(found["problems"], [])
        self.assertEqual(found["focus"], "grid")
        self.assertEqual(path.read_text(encoding="utf-8"), text.replace("DefaultValue=30", "DefaultValue=70000"))

    def test_drag_and_drop(self) -> None:
        self.new("drive.eds")
        for index in (0x2000, 0x2001):
            self.edsc("object", "add", "drive.eds", f"{index:04X}h", f"Value {index:04X}", "UNSIGNED16", "ro", "--mappable")
        self.edsc("object", "map", "drive.eds", "tpdo", 1, "2000h")
        found = self.browse(self.start("drive.eds"), "drag")
        self.assertEqual(found["added"][0::2], ["byte 0 bits 0 to 7, Value 2000 2000h:00", "byte 2 bits 0 to 7, Value 2001 2001h:00"])
        self.assertEqual(found["moved"][0::2], ["byte 0 bits 0 to 7, Value 2001 2001h:00", "byte 2 bits 0 to 7, Value 2000 2000h:00"])

    def test_objects_of_another_file(self) -> None:
        other = self.with_gains()
        self.new("pump.eds")
        found = self.browse(self.start("pump.eds"), "other", other, "gains")
        self.assertIn("2000hGains", found["offered"])
        names = [[entry["name"] for entry in self.entries(name, 0x2000)] for name in ("drive.eds", "pump.eds")]
        self.assertEqual(*names)
        self.edsc("check", "--strict", "pump.eds")

    def test_breaking_change_and_revision(self) -> None:
        self.new("drive.eds", "--revision", "0x00010002")
        self.edsc("object", "add", "drive.eds", "2000h", "Value", "UNSIGNED16", "rw")
        for arguments in (["init", "-q"], ["add", "."], ["-c", "user.name=A", "-c", "user.email=a@b.invalid", "commit", "-qm", "one"]):
            subprocess.run(["git", *arguments], cwd=self.folder, check=True)
        found = self.browse(self.start("drive.eds"), "revision", "2000h", "Type", "UNSIGNED32")
        self.assertIn("Breaking changes since the last commit", found["review"])
        self.assertIn("UNSIGNED32", found["review"])
        self.assertEqual(self.entries("drive.eds", 0x2000)[0]["data_type"], "UNSIGNED32")
        self.assertEqual(self.dump("drive.eds")["revision_number"] >> 16, 2)

    def test_filters(self) -> None:
        shutil.copy(SOURCE_DIR / "eds/rk5c.eds", self.folder / "rk5c.eds")
        objects = self.dump("rk5c.eds")["objects"]
        found = self.browse(self.start("rk5c.eds"), "filters")
        constant = [one for one in objects if any(entry["access"] == "const" for entry in one["entries"])]
        mappable = [one for one in objects if one["index"] >= 0x20 and any(
            entry["pdo_mapping"] and entry["access"] in ("ro", "const", "rw", "rwr") for entry in one["entries"])]
        self.assertEqual(found["const"], f"{len(constant)} of {len(objects)} objects")
        self.assertEqual(found["tpdo"], f"{len(mappable)} of {len(objects)} objects")
        self.assertEqual((found["none"], found["grid"]), (f"0 of {len(objects)} objects", "No object."))

    def with_plant(self) -> Path:
        for name in ("can-2053c", "can-2057c", "rk5c"):
            for path in (SOURCE_DIR / "eds").glob(f"{name}.*"):
                shutil.copy(path, self.folder)
        return Path(shutil.copy(SOURCE_DIR / "examples/line/line.json", self.folder))

    def test_network(self) -> None:
        path = self.with_plant()
        before = path.read_text(encoding="utf-8")
        found = self.browse(self.start("line.json"), "network", "valve", json.dumps({"node_id": "9", "eds": "can-2057c.eds"}),
                            json.dumps({"from": "inputs", "object": "6000h:02", "to": "control", "every_ms": "20"}), "6206h:01", "255", "1")
        self.assertEqual(found["before"]["tabs"], ["Network", "Nodes", "Signals", "Text", "Diff"])
        self.assertFalse(found["before"]["isTreeShown"])
        self.assertNotIn("valve", found["before"]["drawn"])
        self.assertIn("valve", found["withNode"]["drawn"])
        self.assertRegex(found["read"], "^valve9")
        self.assertEqual(found["rejected"]["text"], "200")
        self.assertIn("127", found["rejected"]["message"])
        self.assertIn("1 unsaved edit", found["state"], "the rejected node-ID is not one")
        self.assertIn("error", found["forced"])
        self.assertIn("outputs", found["forced"], "has the same node-ID")
        self.assertGreater(found["withSignal"]["value"], found["withNode"]["value"])
        self.assertNotEqual(found["withSignal"]["load"], found["withNode"]["load"])
        self.assertNotEqual(found["withSignal"]["messages"], found["withNode"]["messages"])
        self.assertNotEqual(found["withSignal"]["drawn"], found["withNode"]["drawn"])
        self.assertEqual(found["undone"], found["withNode"] | {"signals": found["withSignal"]["signals"][:-1]})
        self.assertEqual(found["moved"], [*found["withSignal"]["signals"][:-2], *reversed(found["withSignal"]["signals"][-2:])])
        self.assertEqual(found["name"], "renamed", "the name keeps the focus")
        self.assertIn('+    "renamed"', found["review"])
        self.edsc("network", "check", "line.json")
        made = json.loads(path.read_text(encoding="utf-8"))
        self.assertEqual(made["nodes"]["renamed"], {"node_id": 9, "eds": "can-2057c.eds", "set": {"6206h:01": 255}})
        self.assertEqual(made["signals"][3], {"from": "inputs", "object": "6000h:02", "to": "control", "every_ms": 20})
        for line in before.splitlines():
            if '"from": "encoder"' in line:
                self.assertIn(line, path.read_text(encoding="utf-8").splitlines())

    def test_member_that_is_applied_anyway(self) -> None:
        path = self.with_plant()
        text = path.read_text(encoding="utf-8")
        found = self.browse(self.start("line.json"), "anyway", "2")
        self.assertEqual(found["problems"], [])
        self.assertEqual(found["name"], "Apply anyway: node_id")
        self.assertEqual(found["focus"], "2", "the field has the focus again")
        self.assertEqual(path.read_text(encoding="utf-8"), text.replace('"node_id": 127', '"node_id": 2'))

    def test_node_that_is_added_anyway(self) -> None:
        self.with_plant()
        found = self.browse(self.start("line.json"), "anywayNode", "valve", json.dumps({"node_id": "5", "eds": "can-2057c.eds"}))
        self.assertEqual(found["problems"], [])
        self.assertIn("valve", found["nodes"])

    def test_text_and_focus_in_a_network(self) -> None:
        self.with_plant()
        found = self.browse(self.start("line.json"), "emptyNetwork",
                            json.dumps({"from": "inputs", "object": "6000h:02", "to": "control", "every_ms": "20"}))
        for text in (found["added"], found["moved"]):
            self.assertIn('"every_ms": 20', text)
        self.assertEqual((found["afterSignals"], found["afterNodes"]), ("New signal", "Nodes"), "the lists are empty and hidden")

    def test_signal_before_the_selected_one(self) -> None:
        path = self.with_plant()
        line = 1 + next(at for at, text in enumerate(path.read_text(encoding="utf-8").splitlines(), 1) if '"object": "outputs' in text)
        added = '"signals": [\n    {"from": "inputs", "object": "6000h:02", "to": "control", "every_ms": 50},'
        found = self.browse(self.start("line.json"), "signalBefore", path, '"signals": [', added, f"{line} ")
        self.assertEqual(found["before"], "Signal control to outputs.6200h:01")
        self.assertEqual(found["after"], found["before"])

    def test_accessibility_of_a_network(self) -> None:
        self.with_plant()
        if SCREENSHOTS:
            Path(SCREENSHOTS).mkdir(parents=True, exist_ok=True)
        self.check_accessibility(self.browse(self.start("line.json"), "networkAccess", *([SCREENSHOTS] if SCREENSHOTS else [])))

    def test_hostile_network(self) -> None:
        path = self.with_plant()
        attack = '<img src=x onerror=\\"globalThis.hacked=1\\"></style><script>globalThis.hacked=1</script>'
        text = path.read_text(encoding="utf-8")
        text = text.replace('"encoder"', f'"{attack}"').replace('"every_ms": 100', f'"unit": "{attack}", "every_ms": 100')
        path.write_text(text, encoding="utf-8")
        found = self.browse(self.start("line.json"), "hostileNetwork")
        for names in (found["names"], found["drawn"]):
            self.assertIn(attack.replace("\\", ""), names)
        self.assertEqual((found["images"], found["scripts"], found["isHacked"]), (0, 1, False))

    def test_text_that_is_not_a_network(self) -> None:
        path = self.with_plant()
        found = self.browse(self.start("line.json"), "brokenNetwork", path, '"nodes"', '"nodes')
        self.assertEqual((found["broken"]["isFormShown"], found["broken"]["isPictureShown"]), (False, False))
        self.assertIn("1 error", found["broken"]["findings"])
        self.assertEqual(found["broken"]["violations"], [])
        self.assertIn('"bit_rate"', found["broken"]["text"])
        self.assertEqual((found["corrected"]["isFormShown"], found["corrected"]["isPictureShown"]), (True, True))

    def test_overlay(self) -> None:
        base = self.with_gains()
        before = base.read_bytes()
        (self.folder / "fixed.overlay").write_text("[Overlay]\nVersion=1\nBase=drive.eds\n", encoding="utf-8")
        found = self.browse(self.start("fixed.overlay"), "overlay", "2000h", "Name", "Better gains")
        self.assertIn("base", found["hint"])
        self.assertIn("overlay of drive.eds", found["base"])
        self.assertEqual(base.read_bytes(), before)
        self.assertEqual(next(one for one in self.dump("fixed.overlay")["objects"] if one["index"] == 0x2000)["name"], "Better gains")


def main() -> None:
    program = unittest.main(argv=[sys.argv[0], *sys.argv[4:]], module="__main__", exit=False)
    if program.result.testsRun == 0 and program.result.skipped:
        sys.exit(77)
    sys.exit(not program.result.wasSuccessful())


if __name__ == "__main__":
    main()
