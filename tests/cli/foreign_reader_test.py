#!/usr/bin/env python3
"""npm's canopen, a reader without edsc's code, loads each changed EDS and DCF that it loads before, and finds the change and no other.

    foreign_reader_test.py SOURCE_DIR EDSC WORK_DIR [--each N] [unittest arguments]

Files: those of this repository, and of the folder EDSC_CORPUS if it is set, with --each N every Nth of them. npm installs canopen in
WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from npm_packages import Skipped, install_npm_packages  # noqa: E402

SOURCE_DIR, EDSC, WORK_DIR = (Path(argument).resolve() for argument in sys.argv[1:4])
EACH = int(sys.argv[5]) if sys.argv[4:5] == ["--each"] else 1
NAME, TYPE, ACCESS, MAPPABLE, RAW = range(5)
UNSIGNED8, UNSIGNED16, UNSIGNED32, INTEGER16 = 5, 6, 7, 3
NEW = 0x5F77  # an index that few files have
PDO = 509
Entries = dict[str, list]


def files() -> list[Path]:
    found = sorted((SOURCE_DIR / "eds").glob("*.eds")) + sorted((SOURCE_DIR / "examples").rglob("*.eds"))
    corpus = os.environ.get("EDSC_CORPUS", "")
    if corpus:
        found += sorted(path for path in Path(corpus).rglob("*") if path.suffix.lower() in (".eds", ".dcf"))[::EACH]
    return found


class Reader:
    def __init__(self) -> None:
        self.process = subprocess.Popen(["node", HERE / "foreign_reader.js", WORK_DIR], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)

    def read(self, path: Path) -> Entries | None:
        self.process.stdin.write(f"{path}\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())

    def end(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()


def change(path: Path, action: str, *words: object) -> bool:
    """Whether edsc has made the change; with --force also in a file with errors."""
    result = subprocess.run([EDSC, "object", action, path, *map(str, words), "--force"], capture_output=True, text=True, check=False)
    if result.returncode not in (0, 1):
        raise AssertionError(f"{action} {words}: {result.stderr}")
    return result.returncode == 0


def entries_of_edsc(path: Path) -> dict[str, dict]:
    result = subprocess.run([EDSC, "dump", path, "--keep-going"], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return {}
    return {f"{one['index']:x}:{one['sub_index']:x}": one for thing in json.loads(result.stdout)["objects"] for one in thing["entries"]}


class ForeignReader(unittest.TestCase):
    changed = refused = compared = 0

    @classmethod
    def setUpClass(cls) -> None:
        cls.reader = Reader()
        cls.addClassCleanup(cls.reader.end)
        folder = tempfile.TemporaryDirectory(prefix="edsc-foreign-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)

    def copy(self, file: Path, number: int) -> Path:
        """A copy without its options file, whose errors are not those of this test."""
        path = self.folder / f"{number}{file.suffix.lower()}"
        shutil.copy(file, path)
        path.chmod(0o644)
        return path

    def expect(self, path: Path, expected: Entries) -> None:
        type(self).changed += 1
        self.assertEqual(self.reader.read(path), expected)

    def check_add(self, path: Path, before: Entries) -> Entries:
        if not change(path, "add", f"{NEW:04X}h", "Motor temperature", "INTEGER16", "rw", "--mappable", "--default", -2):
            type(self).refused += 1
            return before
        after = before | {f"{NEW:x}:0": ["Motor temperature", INTEGER16, "rw", True, "feff"]}
        self.expect(path, after)
        return after

    def check_set(self, path: Path, before: Entries, choices: random.Random) -> Entries:
        keys = [key for key, one in before.items() if one[TYPE] in (UNSIGNED8, UNSIGNED16, UNSIGNED32) and one[RAW] and
                int(key.split(":")[0], 16) >= 0x2000]
        if not keys:
            return before
        key = choices.choice(keys)
        index, sub = (int(part, 16) for part in key.split(":"))
        size = len(before[key][RAW]) // 2
        if not change(path, "set", f"{index:04X}h:{sub:02X}", "DefaultValue=37"):
            type(self).refused += 1
            return before
        value = [*before[key][:RAW], (37).to_bytes(size, "little").hex()]
        after = before | {key: value}
        self.expect(path, after)
        return after

    def check_map(self, path: Path, before: Entries) -> None:
        """A new TPDO, and its removal."""
        parameters = 0x1800 + PDO - 1, 0x1A00 + PDO - 1
        if f"{NEW:x}:0" not in before or not change(path, "map", "tpdo", PDO, f"{NEW:04X}h", "--transmission-type", 254):
            return
        after = self.reader.read(path)
        added = {key: one for key, one in after.items() if key not in before}
        self.assertEqual({key: (one[TYPE], one[RAW]) for key, one in added.items()},
                         {f"{parameters[0]:x}:1": (UNSIGNED32, "00000080"), f"{parameters[0]:x}:2": (UNSIGNED8, "fe"),
                          f"{parameters[1]:x}:1": (UNSIGNED32, f"1000{NEW & 0xFF:02x}{NEW >> 8:02x}")})
        self.assertEqual({key: one for key, one in after.items() if key in before}, before)
        self.assertTrue(change(path, "remove", *(f"{index:04X}h" for index in parameters)))
        self.expect(path, before)

    def check_remove(self, path: Path, before: Entries) -> None:
        if f"{NEW:x}:0" not in before or not change(path, "remove", f"{NEW:04X}h"):
            return
        self.expect(path, {key: one for key, one in before.items() if key != f"{NEW:x}:0"})

    def check_values_of_edsc(self, path: Path, entries: Entries) -> None:
        """Numbers of an EDS from 2000h on, which CiA 301 does not fix; canopen does not read ParameterValue or $NODEID."""
        ours = entries_of_edsc(path) if path.suffix == ".eds" else {}
        for key, one in entries.items():
            number = ours.get(key, {}).get("default_value")
            if int(key.split(":")[0], 16) < 0x2000 or one[TYPE] not in (UNSIGNED8, UNSIGNED16, UNSIGNED32) or one[RAW] is None:
                continue
            if not isinstance(number, int):
                continue
            if int(key.split(":")[1], 16) == 0 and f"{key.split(':')[0]}:1" in entries:
                continue  # canopen counts sub-objects itself
            value = int.from_bytes(bytes.fromhex(one[RAW]), "little")
            if value == 0:
                continue  # also a missing value, for which edsc may know a default of CiA 301, and one with $NODEID
            type(self).compared += 1
            self.assertEqual(value, number, key)

    def test_changes(self) -> None:
        choices = random.Random(7)
        loaded = 0
        for number, file in enumerate(files()):
            with self.subTest(file=str(file)):
                path = self.copy(file, number)
                before = self.reader.read(path)
                if before is None or f"{NEW:x}:0" in before:
                    continue
                loaded += 1
                after = self.check_add(path, before)
                after = self.check_set(path, after, choices)
                self.check_map(path, after)
                self.check_remove(path, after)
                self.check_values_of_edsc(path, self.reader.read(path))
                path.unlink()
        print(f"{loaded} files, {self.changed} changes, {self.refused} refused, {self.compared} values compared")
        self.assertGreater(loaded, 10)
        self.assertGreater(self.changed, 2 * loaded)
        self.assertGreater(self.compared, loaded)


if __name__ == "__main__":
    try:
        install_npm_packages(HERE.parent / "masters/node_canopen", WORK_DIR)
    except Skipped as reason:
        print(f"skipped: {reason}")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[6 if EACH != 1 else 4:]])
