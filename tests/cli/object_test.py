#!/usr/bin/env python3
"""`edsc object`: each action, its exit codes, and the files that it must not change.

    object_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import gzip
import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from cli_test import EDSC, FINE, INPUT_HAS_ERRORS, SOURCE_DIR, WRONG_USAGE, CommandLine

DRIVE = SOURCE_DIR / "eds/cpd.eds"


class ObjectCommand(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        shutil.copy(DRIVE, self.folder / "drive.eds")
        self.before = DRIVE.read_bytes()

    def run_edsc(self, *words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=600)

    def change(self, action: str, *words: object, status: int = FINE) -> subprocess.CompletedProcess[str]:
        result = self.run_edsc("object", action, "drive.eds", *words)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        if status != FINE:
            self.assertEqual(self.path("drive.eds").read_bytes(), self.before)
        return result

    def path(self, name: str) -> Path:
        return Path(self.folder) / name

    def objects(self) -> dict[int, dict]:
        result = self.run_edsc("dump", "drive.eds")
        self.assertEqual(result.returncode, FINE, result.stderr)
        return {one["index"]: one for one in json.loads(result.stdout)["objects"]}

    def entry(self, index: int, sub_index: int = 0) -> dict:
        return next(one for one in self.objects()[index]["entries"] if one["sub_index"] == sub_index)

    def assert_canonical(self) -> None:
        self.assertEqual(self.run_edsc("format", "--check", "drive.eds").returncode, FINE)


class Add(ObjectCommand):
    def test_a_value(self) -> None:
        self.assert_canonical()
        result = self.change("add", "5F00h", "Motor temperature", "INTEGER16", "ro", "--mappable", "--unit", "0.1 degC",
                             "--low=-400", "--high", 1500)
        self.assertEqual(result.stdout, "drive.eds: add 5F00h\n")
        entry = self.entry(0x5F00)
        self.assertEqual((entry["data_type"], entry["access"], entry["pdo_mapping"]), ("INTEGER16", "ro", True))
        self.assertEqual((entry["low_limit"], entry["high_limit"]), (-400, 1500))
        self.assertEqual((entry["unit"], entry["factor"]), ("degC", "0.1"))
        self.assert_canonical()

    def test_an_array_and_a_record(self) -> None:
        self.change("add", "5F10h", "Gains", "UNSIGNED16[8]", "rw", "--default", 100)
        self.change("add", "5F20h", "Limits", "--record", "Speed:UNSIGNED16:rw=3000,Current:u8:ro=5")
        self.assertEqual([one.get("default_value") for one in self.objects()[0x5F10]["entries"]], [8] + [100] * 8)
        self.assertEqual([(one["name"], one["data_type"], one["default_value"]) for one in self.objects()[0x5F20]["entries"]][1:],
                         [("Speed", "UNSIGNED16", 3000), ("Current", "UNSIGNED8", 5)])
        self.assert_canonical()

    def test_objects_of_the_standards(self) -> None:
        objects = self.objects()
        wanted = [index for index in (0x1002, 0x1010, 0x1012, 0x1016, 0x1029, 0x6066, 0x607D, 0x6086) if index not in objects]
        self.assertGreater(len(wanted), 2)
        self.change("add", *(f"{index:04X}h" for index in wanted))
        objects = self.objects()
        self.assertTrue(set(wanted) <= set(objects))
        self.assert_canonical()

    def test_records_of_the_standards(self) -> None:
        """Each RECORD that CiA 301 and CiA 402 have, in a new drive: `check --strict` accepts it. Names and types are those of the
        standards."""
        self.assertEqual(self.run_edsc("new", "drive.eds.eds", "--vendor-name", "Acme", "--cia", 402).returncode, FINE)
        self.path("drive.eds.eds").replace(self.path("drive.eds"))
        self.change("add", "1020h", "1200h", "1280h", "1403h", "1603h[4]", "1803h", "1A03h[4]")
        self.change("add", "6048h", "6049h", "60C2h", "60C4h", "6091h", "607Dh", "60FEh", "6848h")
        self.assertEqual([(one["sub_index"], one["name"], one["data_type"], one["access"])
                          for one in self.objects()[0x60C4]["entries"]][1:],
                         [(1, "Maximum buffer size", "UNSIGNED32", "ro"), (2, "Actual buffer size", "UNSIGNED32", "rw"),
                          (3, "Buffer organization", "UNSIGNED8", "rw"), (4, "Buffer position", "UNSIGNED16", "rw"),
                          (5, "Size of data record", "UNSIGNED8", "wo"), (6, "Buffer clear", "UNSIGNED8", "wo")])
        self.assertEqual([one["data_type"] for one in self.objects()[0x6848]["entries"]], ["UNSIGNED8", "UNSIGNED32", "UNSIGNED16"])
        self.assertEqual([one["name"] for one in self.objects()[0x607D]["entries"]][1:], ["Min position limit", "Max position limit"])
        self.assertEqual({one["sub_index"]: one.get("default_value") for one in self.objects()[0x1803]["entries"]},
                         {0: 5, 1: "$NODEID+0x480", 2: 0, 3: 0, 5: 0})
        self.assertEqual([one.get("default_value") for one in self.objects()[0x1603]["entries"]], [0, 0, 0, 0, 0])
        self.assert_canonical()
        checked = self.run_edsc("check", "--strict", "drive.eds")
        self.assertEqual(checked.returncode, FINE, checked.stdout + checked.stderr)

    def test_copies(self) -> None:
        source = next(index for index in sorted(self.objects()) if index >= 0x2000)
        self.change("add", "--like", f"{source:04X}h", "5F30h", "5F31h")
        objects = self.objects()
        kinds = [[(one["name"], one["data_type"]) for one in objects[index]["entries"]] for index in (source, 0x5F30, 0x5F31)]
        self.assertEqual(kinds[0], kinds[1])
        self.assertEqual(kinds[0], kinds[2])
        shutil.copy(self.path("drive.eds"), self.path("other.eds"))
        self.change("remove", "5F30h-5F31h")
        self.change("add", "--from", "other.eds", "5F00h-5FFFh")
        self.assertEqual(self.objects().keys(), objects.keys())
        self.assertEqual(self.path("drive.eds").read_bytes(), self.path("other.eds").read_bytes())

    def test_what_is_rejected(self) -> None:
        self.assertIn("already exists", self.change("add", "1017h", status=INPUT_HAS_ERRORS).stderr)
        self.assertIn("does not know", self.change("add", "2F77h", status=INPUT_HAS_ERRORS).stderr)
        self.change("add", "5F00h", "Name", "UNSIGNED99", status=WRONG_USAGE)
        self.change("add", "5F00h", "Name", "UNSIGNED8", "rx", status=WRONG_USAGE)
        self.change("add", "5F00h", "Limits", "--record", "Speed:rw", status=WRONG_USAGE)
        refused = self.change("add", "5F00h", "Temperature in °C", "UNSIGNED8", "rw", status=INPUT_HAS_ERRORS)
        self.assertIn("--utf8", refused.stderr)
        self.change("add", "5F00h", "Temperature in °C", "UNSIGNED8", "rw", "--utf8")
        self.assertEqual(self.entry(0x5F00)["name"], "Temperature in °C")


class Change(ObjectCommand):
    def test_a_range(self) -> None:
        self.change("add", "5F10h", "Gains", "UNSIGNED16[8]", "rw", "--default", 100)
        before = self.path("drive.eds").read_text()
        self.change("set", "5F10h:02-03", "HighLimit=500", "DefaultValue=20")
        self.assertEqual([self.entry(0x5F10, sub).get("high_limit") for sub in range(1, 5)], [None, 500, 500, None])
        self.assertEqual([self.entry(0x5F10, sub)["default_value"] for sub in range(1, 5)], [100, 20, 20, 100])
        self.change("set", "5F10h:02-03", "HighLimit=")
        self.change("set", "5F10h:02-03", "DefaultValue=100")
        self.assertEqual(self.path("drive.eds").read_text(), before)

    def test_a_dry_run_is_a_patch(self) -> None:
        result = self.change("set", "DeviceInfo", "ProductName=Other", "--dry-run")
        self.assertEqual(self.path("drive.eds").read_bytes(), self.before)
        other = self.path("other")
        other.mkdir()
        shutil.copy(self.path("drive.eds"), other)
        patched = subprocess.run(["git", "apply", "-p0"], input=result.stdout, cwd=other, text=True, capture_output=True)
        self.assertEqual(patched.returncode, 0, patched.stderr)
        self.change("set", "DeviceInfo", "ProductName=Other")
        self.assertEqual((other / "drive.eds").read_bytes(), self.path("drive.eds").read_bytes())

    def test_the_identity(self) -> None:
        self.change("set", "1018h:01", "DefaultValue=0x777")
        dump = json.loads(self.run_edsc("dump", "drive.eds").stdout)
        self.assertEqual(dump["vendor_number"], 0x777)

    def test_new_errors(self) -> None:
        result = self.change("set", "1017h", "DefaultValue=soon", status=INPUT_HAS_ERRORS)
        self.assertIn("--force", result.stderr)
        self.change("set", "1017h", "DefaultValue=soon", "--force")
        self.assertIn("DefaultValue=soon", self.path("drive.eds").read_text())

    def test_a_stamp(self) -> None:
        revision = json.loads(self.run_edsc("dump", "drive.eds").stdout)["file_info"]["file_revision"]
        self.change("set", "1017h", "ParameterName=Heartbeat", "--stamp")
        info = json.loads(self.run_edsc("dump", "drive.eds").stdout)["file_info"]
        self.assertEqual(int(info["file_revision"]), int(revision) + 1)
        self.assertRegex(info["modification_date"], r"^\d\d-\d\d-\d{4}$")
        self.assertRegex(info["modification_time"], r"^\d\d:\d\d[AP]M$")
        self.assert_canonical()


class Map(ObjectCommand):
    def pdo(self, direction: str, number: int) -> dict:
        dump = json.loads(self.run_edsc("dump", "drive.eds").stdout)
        return next(one for one in dump["pdos"] if one["direction"] == direction and one["number"] == number)

    def test_a_new_pdo(self) -> None:
        self.change("add", "5F00h", "Motor temperature", "INTEGER16", "ro", "--mappable")
        self.change("map", "tpdo", 260, "6041h", "5F00h", "--cob-id", "0x1F0", "--transmission-type", 255, "--event-timer",
                    "100ms", "--inhibit", "2ms")
        pdo = self.pdo("transmit", 260)
        self.assertEqual([(one["index"], one["bits"]) for one in pdo["entries"]], [(0x6041, 16), (0x5F00, 16)])
        values = {one["sub_index"]: one.get("default_value") for one in self.objects()[0x1800 + 259]["entries"]}
        self.assertEqual((values[1], values[2], values[3], values[5]), (0x1F0, 255, 20, 100))
        self.assert_canonical()

    def test_a_mapped_object_moves_and_is_not_removed(self) -> None:
        self.change("add", "5F00h", "Motor temperature", "INTEGER16", "ro", "--mappable")
        self.change("map", "tpdo", 260, "6041h", "5F00h", "--cob-id", "0x1F0")
        self.before = self.path("drive.eds").read_bytes()
        refused = self.change("remove", "5F00h", status=INPUT_HAS_ERRORS)
        self.assertIn("5F00h:00 is mapped by TPDO 260", refused.stderr)
        self.change("rename", "5F00h", "5F05h")
        self.assertEqual([one["index"] for one in self.pdo("transmit", 260)["entries"]], [0x6041, 0x5F05])
        self.change("map", "tpdo", 260, "none")
        self.change("remove", "5F05h")
        self.assertNotIn(0x5F05, self.objects())
        self.assert_canonical()

    def compact_drive(self) -> None:
        """The mapping of TPDO 260 as an object with CompactSubObj and a list of its values."""
        self.change("map", "tpdo", 260, "6041h", "--cob-id", "0x1F0")
        self.change("remove", "1B03h", "--force")
        self.path("drive.eds").write_bytes(self.path("drive.eds").read_bytes() + (
            b"\n[1B03]\nParameterName=TPDO mapping parameter\nObjectType=0x9\nDataType=0x0007\nAccessType=rw\nPDOMapping=0\n"
            b"CompactSubObj=2\n\n[1B03Value]\nNrOfEntries=2\n1=0x60410010\n2=0x60610008 ; mode\n"))
        text = self.path("drive.eds").read_text(encoding="utf-8")
        count = int(text[text.index("[OptionalObjects]"):].split("SupportedObjects=")[1].split()[0], 0)
        self.path("drive.eds").write_text(text.replace(f"SupportedObjects={count}\n", f"SupportedObjects={count + 1}\n{count + 1}=0x1B03\n"))

    def test_a_compact_mapping(self) -> None:
        self.compact_drive()
        self.assertEqual([one["index"] for one in self.pdo("transmit", 260)["entries"]], [0x6041, 0x6061])
        self.change("map", "tpdo", 260, "6061h", "6041h", "6064h")
        self.assertEqual([one["index"] for one in self.pdo("transmit", 260)["entries"]], [0x6061, 0x6041, 0x6064])
        text = self.path("drive.eds").read_text(encoding="utf-8")
        self.assertIn("CompactSubObj=3\n\n[1B03Value]\nNrOfEntries=3\n1=0x60610008\n2=0x60410010", text)
        self.change("map", "tpdo", 260, "6064h")
        self.assertEqual([one["index"] for one in self.pdo("transmit", 260)["entries"]], [0x6064])
        self.assertIn("CompactSubObj=1\n\n[1B03Value]\nNrOfEntries=1\n1=0x60640020\n",
                      self.path("drive.eds").read_text(encoding="utf-8"))
        self.change("map", "tpdo", 260, "none")
        self.assertEqual(self.pdo("transmit", 260)["entries"], [])
        self.change("map", "tpdo", 260, "6041h", "6061h")
        self.assertEqual([one["index"] for one in self.pdo("transmit", 260)["entries"]], [0x6041, 0x6061])

    def test_what_cannot_be_mapped(self) -> None:
        self.change("map", "tpdo", 1, "1018h:01", status=INPUT_HAS_ERRORS)
        self.change("map", "tpdo", 1, "9999h", status=INPUT_HAS_ERRORS)
        self.change("map", "tpdo", 1, "--inhibit", "150us", status=WRONG_USAGE)


class Table(ObjectCommand):
    def test_an_exported_table_changes_nothing(self) -> None:
        self.change("export", "-o", "objects.csv")
        self.change("import", "objects.csv")
        self.assertEqual(self.path("drive.eds").read_bytes(), self.before)

    def test_new_and_changed_rows(self) -> None:
        self.write("objects.csv", "index,sub,name,type,access,default,low,high,unit\n"
                                  "1017h,,\"Heartbeat, producer\",,,250,,,\n"
                                  "5F40h,,Speed,INTEGER32,rw,-5,-10,10,0.1 rpm\n"
                                  "5F41h,,List,ARRAY,,,,,\n5F41h,00,Highest sub-index,UNSIGNED8,const,1,,,\n"
                                  "5F41h,01,First,UNSIGNED16,rw,7,,,\n")
        self.change("import", "objects.csv")
        self.assertEqual((self.entry(0x1017)["name"], self.entry(0x1017)["default_value"]), ("Heartbeat, producer", 250))
        speed = self.entry(0x5F40)
        self.assertEqual((speed["default_value"], speed["low_limit"], speed["unit"], speed["factor"]), (-5, -10, "rpm", "0.1"))
        self.assertEqual(self.entry(0x5F41, 1)["default_value"], 7)
        self.assert_canonical()

    def test_wrong_tables(self) -> None:
        for text in ("", "index,sub\n", "index,sub,name,type,access,default,low,high,unit\n2x,,a,,,,,,\n",
                     "index,sub,name,type,access,default,low,high,unit\n2000h,,a,UNSIGNED99,,,,,\n"):
            self.write("objects.csv", text)
            self.change("import", "objects.csv", status=INPUT_HAS_ERRORS)


class Files(ObjectCommand):
    def refused(self, name: str, message: str) -> None:
        before = self.path(name).read_bytes()
        result = self.run_edsc("object", "remove", name, "1017h")
        self.assertEqual(result.returncode, WRONG_USAGE, result.stdout + result.stderr)
        self.assertIn(message, result.stderr)
        self.assertEqual(self.path(name).read_bytes(), before)

    def test_files_that_are_not_changed(self) -> None:
        self.path("drive.eds.gz").write_bytes(gzip.compress(self.before))
        self.refused("drive.eds.gz", "gzip")
        shutil.copy(SOURCE_DIR / "examples/xdd/drive.xdd", self.path("drive.xdd"))
        self.refused("drive.xdd", "edsc format")
        self.write("drive.overlay", "[Overlay]\nVersion=1\nBase=drive.eds\n")
        self.refused("drive.overlay", "overlay")
        self.assertEqual(self.run_edsc("object", "remove", "missing.eds", "1017h").returncode, WRONG_USAGE)
        self.assertEqual(self.run_edsc("object", "remove", "-", "1017h").returncode, WRONG_USAGE)

    def test_the_bytes_of_other_lines(self) -> None:
        bytes_before = b"\xef\xbb\xbf" + self.before.replace(b"\n", b"\r\n").replace(b"[1017]\r\n", b" [1017] \n;c\r")
        self.path("drive.eds").write_bytes(bytes_before)
        self.change("set", "1017h", "ParameterName=Heartbeat")
        after = self.path("drive.eds").read_bytes()
        old_lines, new_lines = bytes_before.split(b"\n"), after.split(b"\n")
        self.assertEqual(len(old_lines), len(new_lines))
        self.assertEqual(sum(old != new for old, new in zip(old_lines, new_lines)), 1)
        self.assertTrue(after.startswith(b"\xef\xbb\xbf"))

    def test_the_mode_of_the_file(self) -> None:
        os.chmod(self.path("drive.eds"), 0o640)
        self.change("set", "1017h", "ParameterName=Heartbeat")
        self.assertEqual(self.path("drive.eds").stat().st_mode & 0o777, 0o640)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
