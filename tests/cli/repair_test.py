#!/usr/bin/env python3
"""edsc check --repair: a file with a fault in all places becomes the device that it was without the fault.

    repair_test.py SOURCE_DIR EDSC

The oracle is the file before the fault was planted: the repaired file must describe the same device, so that no repair has changed a
right value. One repaired device is also compiled and tested in simulated time.
"""

from __future__ import annotations

import json
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, EDSC = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/generator/lint"))
from planted_faults_test import SYSTEMATIC, types_moved  # noqa: E402

NOT_REPAIRED = {
    "no lists of objects": "an object list that is missing is written with all its objects",
    "limits without meaning": "what the limits are, nobody knows",
    "the file twice": "the second half is not used",
    "no section DeviceInfo": "vendor, product and bit rates are in no other section",
    "no object codes": "objects of the manufacturer may be ARRAYs or RECORDs",
    "objects with sub-objects are VARs": "the same",
}
NOT_REPAIRED_IN = {
    ("node-ID 1 in each CAN-ID", "cpc-tc1.eds"): "CAN-IDs of PDOs that are disabled by default are not reported",
    ("sub-indices are decimal", "cpc-tc1.eds"): "no sub-index 0 states the highest sub-index, so that it is not certain",
}
NO_COMPILER = {**os.environ, "CXX": "no-compiler"}


def device_of(dump: dict) -> dict:
    """A device without the places of its values, and without keys that only the spelling of the file has."""

    def plain(value: object) -> object:
        if isinstance(value, dict):
            return {key: plain(one) for key, one in value.items() if key not in ("line", "file", "column", "source")}
        return [plain(one) for one in value] if isinstance(value, list) else value

    return plain(dump)


class Repair(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def edsc(self, *arguments: object, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *map(str, arguments)], capture_output=True, text=True, timeout=900, env=env)

    def dump(self, path: Path) -> dict:
        shown = self.edsc("dump", path, "--keep-going")
        self.assertEqual(shown.returncode, 0, shown.stderr)
        return device_of(json.loads(shown.stdout))

    def plant(self, what: str, name: str) -> tuple[Path, Path] | None:
        change = next(row[2] for row in SYSTEMATIC if row[0] == what)
        text = (SOURCE_DIR / "eds" / name).read_text(encoding="utf-8")
        planted = change(text, random.Random(1))
        if planted is None or planted == text:
            return None
        (self.folder / "right").mkdir(exist_ok=True)
        right, wrong = self.folder / "right/device.eds", self.folder / "device.eds"
        right.write_text(text, encoding="utf-8")
        wrong.write_text(planted, encoding="utf-8")
        return right, wrong

    def test_makes_the_device_of_the_file_without_the_fault(self) -> None:
        repaired = 0
        for what, rule, _ in SYSTEMATIC:
            if what in NOT_REPAIRED:
                continue
            for name in ("can-2017c.eds", "cpc-tc1.eds", "ezd-1136.eds"):
                files = self.plant(what, name)
                if files is None or (what, name) in NOT_REPAIRED_IN:
                    continue
                with self.subTest(what=what, file=name):
                    right, wrong = files
                    overlay = self.folder / "device.overlay"
                    overlay.unlink(missing_ok=True)
                    ran = self.edsc("check", wrong, "--repair", "-o", overlay, env=NO_COMPILER)
                    self.assertTrue(overlay.is_file(), ran.stdout + ran.stderr)
                    self.assertIn(rule, ran.stdout)
                    self.assertEqual(self.dump(right), self.dump(overlay))
                    self.assertEqual(self.edsc("check", overlay, "--strict", "--silence", "sub-index-0-access").stdout.count("overlay-"), 0)
                    repaired += 1
        self.assertGreaterEqual(repaired, 20)

    def test_states_that_sub_indices_are_decimal(self) -> None:
        text = (SOURCE_DIR / "eds/cpd.eds").read_text(encoding="utf-8")
        subs = "".join(f"[2FF0sub{n}]\nParameterName=Element {n}\nDataType=0x0005\nAccessType={'ro' if n == 0 else 'rw'}\n"
                       + ("DefaultValue=12\n" if n == 0 else "") for n in range(13))
        wrong, overlay = self.folder / "cpd.eds", self.folder / "cpd.overlay"
        wrong.write_text(f"{text}\n[2FF0]\nParameterName=Elements\nObjectType=0x8\nSubNumber=13\n{subs}", encoding="utf-8")
        self.edsc("check", wrong, "--repair", "-o", overlay, env=NO_COMPILER)
        self.assertIn("SubIndices=decimal\n", overlay.read_text(encoding="utf-8"))
        (elements,) = (one for one in self.dump(overlay)["objects"] if one["index"] == 0x2FF0)
        self.assertEqual([entry["sub_index"] for entry in elements["entries"]], list(range(13)))

    def test_gives_a_value_to_a_key_without_one(self) -> None:
        text = (SOURCE_DIR / "eds/can-2017c.eds").read_text(encoding="utf-8")
        planted = re.sub(r"(\[1018sub0\]\n(?:[^\[\n].*\n)*?DataType=).*", r"\g<1># of the count", text)
        self.assertNotEqual(planted, text)
        (self.folder / "right").mkdir()
        right, wrong, overlay = (self.folder / name for name in ("right/device.eds", "device.eds", "device.overlay"))
        right.write_text(text, encoding="utf-8")
        wrong.write_text(planted, encoding="utf-8")
        ran = self.edsc("check", wrong, "--repair", "-o", overlay, env=NO_COMPILER)
        self.assertNotIn("overlay-", ran.stdout)
        self.assertEqual(self.dump(right), self.dump(overlay))

    def test_gives_a_reason_for_each_line(self) -> None:
        _, wrong = self.plant("node-ID 1 in each CAN-ID", "can-2017c.eds")
        overlay = self.folder / "device.overlay"
        self.edsc("check", wrong, "--repair", "-o", overlay, env=NO_COMPILER)
        text = overlay.read_text(encoding="utf-8")
        self.assertIn("Base=device.eds\n", text)
        self.assertRegex(text, r"\[1800sub1\]\n; CAN-ID of 1800h for any node \(CiA 301, [0-9.]+\)\n"
                               r"DefaultValue=0x181 => \$NODEID\+0x180\n")
        self.assertNotIn("overlay-reason", self.edsc("check", overlay, "--strict").stdout)

    def test_tries_the_device_in_simulated_time(self) -> None:
        text = types_moved(1)((SOURCE_DIR / "eds/rk5c.eds").read_text(encoding="utf-8"), random.Random(1))
        wrong, overlay = self.folder / "rk5c.eds", self.folder / "rk5c.overlay"
        wrong.write_text(text, encoding="utf-8")
        options = SOURCE_DIR / "eds/rk5c.options.json"
        ran = self.edsc("check", wrong, "--repair", "-o", overlay, "--options", options)
        self.assertIn("its conformance test in simulated time", ran.stdout, ran.stderr)
        summary = re.search(r"(\d+) passed", ran.stdout)
        self.assertIsNotNone(summary, ran.stdout)
        self.assertGreater(int(summary[1]), 40)

    def test_says_that_a_device_was_not_tried(self) -> None:
        _, wrong = self.plant("no SubNumber fits", "rk5c.eds")
        ran = self.edsc("check", wrong, "--repair", "-o", self.folder / "device.overlay", env=NO_COMPILER)
        self.assertEqual(ran.returncode, 1)
        self.assertIn("the device was not tried: cannot start the C++ compiler no-compiler", ran.stdout)

    def test_writes_nothing_without_a_remedy(self) -> None:
        ran = self.edsc("check", SOURCE_DIR / "eds/rk5c.eds", "--repair", "-o", self.folder / "x.overlay")
        self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
        self.assertIn("no finding has a certain remedy", ran.stdout)
        self.assertFalse((self.folder / "x.overlay").exists())

    def test_does_not_repair_what_is_silenced(self) -> None:
        _, wrong = self.plant("no SubNumber fits", "rk5c.eds")
        ran = self.edsc("check", wrong, "--repair", "-o", self.folder / "x.overlay", "--silence", "sub-number", env=NO_COMPILER)
        self.assertIn("no finding has a certain remedy", ran.stdout)
        self.assertEqual(self.edsc("check", wrong, "--repair", "-o", self.folder / "x.overlay", "--strict").returncode, 2)

    def test_repairs_an_xdd(self) -> None:
        text = (SOURCE_DIR / "examples/xdd/drive.xdd").read_text(encoding="utf-8")
        planted = re.sub(r'subNumber="(\d+)"', lambda at: f'subNumber="{int(at[1]) - 1}"', text)
        self.assertNotEqual(planted, text)
        (self.folder / "right").mkdir()
        right, wrong, overlay = (self.folder / name for name in ("right/device.xdd", "device.xdd", "device.overlay"))
        right.write_text(text, encoding="utf-8")
        wrong.write_text(planted, encoding="utf-8")
        self.edsc("check", wrong, "--repair", "-o", overlay, env=NO_COMPILER)
        self.assertIn("Base=device.xdd\n", overlay.read_text(encoding="utf-8"))
        self.assertEqual(self.dump(right)["objects"], self.dump(overlay)["objects"])

    def test_needs_a_file_to_write(self) -> None:
        ran = self.edsc("check", SOURCE_DIR / "eds/rk5c.eds", "--repair")
        self.assertEqual(ran.returncode, 2)
        self.assertIn("--output", ran.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
