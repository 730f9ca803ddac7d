#!/usr/bin/env python3
"""`edsc merge` as merge driver of git: random branches whose changes do not meet have the same result in both directions, and
real conflicts have markers in their section only.

    merge_test.py SOURCE_DIR EDSC [unittest arguments]

The oracle of a merge without conflict is the file with the changes of both branches, one after another.
"""

from __future__ import annotations

import random
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from cli_test import EDSC, FINE, INPUT_HAS_ERRORS, SOURCE_DIR, CommandLine

DRIVE = SOURCE_DIR / "eds/cpd.eds"


class Merge(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.repository = Path(self.folder) / "repository"
        self.repository.mkdir()
        self.git("init", "-q", "-b", "base")
        self.git("config", "merge.edsc.driver", f"'{EDSC}' merge %O %A %B %P")
        (self.repository / ".gitattributes").write_text("*.eds merge=edsc\n")
        self.commit(DRIVE.read_bytes())

    def git(self, *words: str, status: int = 0) -> str:
        result = subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@example.org", *words], cwd=self.repository,
                                capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result.stdout + result.stderr

    @property
    def drive(self) -> Path:
        return self.repository / "drive.eds"

    def commit(self, content: bytes | None = None) -> None:
        if content is not None:
            self.drive.write_bytes(content)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "change", "--allow-empty")

    def change(self, *words: str) -> None:
        action, *others = words
        result = subprocess.run([EDSC, "object", action, self.drive, *others], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, FINE, f"{words}: {result.stderr}")

    def branch(self, name: str, changes: list[tuple[str, ...]]) -> None:
        self.git("checkout", "-q", "-b", name, "base")
        for words in changes:
            self.change(*words)
        self.commit()

    def canonical(self) -> str:
        result = subprocess.run([EDSC, "format", self.drive], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, FINE, result.stderr)
        return result.stdout

    def merged(self, ours: list[tuple[str, ...]], theirs: list[tuple[str, ...]]) -> str:
        self.git("checkout", "-q", "base")
        for name in ("ours", "theirs"):
            subprocess.run(["git", "branch", "-D", name], cwd=self.repository, capture_output=True)
        self.branch("theirs", theirs)
        self.branch("ours", ours)
        self.git("merge", "-q", "--no-edit", "theirs")
        return self.canonical()

    def in_sequence(self, changes: list[tuple[str, ...]]) -> str:
        shutil.copy(DRIVE, self.drive)
        for words in changes:
            self.change(*words)
        text = self.canonical()
        self.git("checkout", "-q", "-f")
        return text

    def test_random_branches(self) -> None:
        choices = random.Random(5)
        changes: list[tuple[str, ...]] = [
            ("add", "5F00h", "Speed", "UNSIGNED16", "rw"), ("add", "5F01h", "Force", "INTEGER32", "ro"),
            ("add", "5F02h", "Gains", "UNSIGNED8[3]", "rw"), ("set", "1017h", "ParameterName=Heartbeat"),
            ("set", "1017h", "DefaultValue=250"), ("set", "DeviceInfo", "ProductName=Other"),
            ("set", "1018h:03", "DefaultValue=0x20000"), ("remove", "6086h"), ("remove", "6083h"),
            ("map", "tpdo", "300", "6041h", "--cob-id", "0x1F0"), ("map", "rpdo", "301", "6040h", "--cob-id", "0x1F1"),
            ("add", "5F03h", "Limits", "--record", "Low:INTEGER16:rw=1,High:INTEGER16:rw=2"),
        ]
        text = DRIVE.read_text(encoding="utf-8")
        changes = [words for words in changes if words[0] != "remove" or f"[{words[1][:4]}]" in text]
        for _ in range(8):
            chosen = choices.sample(changes, 6)
            ours, theirs = chosen[:3], chosen[3:]
            with self.subTest(ours=ours, theirs=theirs):
                expected = self.in_sequence(ours + theirs)
                self.assertEqual(self.merged(ours, theirs), expected)
                self.assertEqual(self.merged(theirs, ours), expected)

    def test_both_branches_add_sub_objects(self) -> None:
        self.change("add", "5F00h", "Gains", "UNSIGNED8[2]", "rw")
        self.commit()
        text = self.canonical()
        self.git("checkout", "-q", "-b", "theirs")
        self.drive.write_text(text.replace("SubNumber=3\n\n[5F00sub0]", "SubNumber=3\n\n[5F00sub0]"))
        self.change("rename", "5F00h:02", "5F00h:04")
        self.commit()
        self.git("checkout", "-q", "-b", "ours", "base")
        self.change("set", "5F00h:01", "DefaultValue=9")
        self.commit()
        self.git("merge", "-q", "--no-edit", "theirs")
        merged = self.canonical()
        section = merged[merged.index("[5F00sub0]"):merged.index("[5F00sub1]")]
        self.assertIn("DefaultValue=4", section)
        self.assertIn("[5F00sub4]", merged)
        self.assertIn("DefaultValue=9", merged[merged.index("[5F00sub1]"):merged.index("[5F00sub4]")])

    def edit(self, name: str, *replacements: tuple[str, str]) -> None:
        """A branch that an editor makes: texts of the file are replaced."""
        self.git("checkout", "-q", "-b", name, "base")
        text = self.drive.read_text(encoding="utf-8")
        for old, new in replacements:
            self.assertEqual(text.count(old), 1, old)
            text = text.replace(old, new)
        self.commit(text.encode())

    def test_comments(self) -> None:
        """Comments of one branch, with values of the other one: each before its key, after the last key or above its section."""
        self.edit("start", ("[1017]\n", "; old\n; reason\n[1017]\n"))
        self.git("checkout", "-q", "base")
        self.git("merge", "-q", "--ff-only", "start")
        name = next(line for line in self.drive.read_text().split("[1017]\n")[1].splitlines() if line.startswith("ParameterName"))
        section = "[1017]\n" + name
        self.edit("theirs", ("; old\n; reason\n" + section, "; new reason\n[1017]\n; the name\n" + name),
                  ("[1018]\n", "; identity, by the label\n[1018]\n"))
        self.branch("ours", [("set", "1017h", "DefaultValue=222"), ("add", "5F00h", "Speed", "UNSIGNED16", "rw")])
        self.git("merge", "-q", "--no-edit", "theirs")
        text = self.drive.read_text(encoding="utf-8")
        self.assertIn("; new reason\n[1017]\n; the name\n" + name, text)
        self.assertIn("; identity, by the label\n[1018]\n", text)
        self.assertNotIn("; old", text)
        self.assertIn("DefaultValue=222", text[text.index("[1017]"):])
        self.assertIn("[5F00]", text)

    def test_a_conflict_of_comments(self) -> None:
        self.edit("theirs", ("[1018sub1]\n", "; theirs\n[1018sub1]\n"))
        self.edit("ours", ("[1018sub1]\n", "; ours\n[1018sub1]\n"))
        output = self.git("merge", "-q", "--no-edit", "theirs", status=INPUT_HAS_ERRORS)
        self.assertIn("drive.eds: conflict in [1018sub1]", output)
        text = self.drive.read_text(encoding="utf-8")
        self.assertTrue("<<<<<<< ours\n; ours\n=======\n; theirs\n>>>>>>> theirs\n[1018sub1]\n" in text)
        self.assertEqual(text.count("<<<<<<<"), 1)

    def test_a_conflict_of_a_value(self) -> None:
        self.branch("theirs", [("set", "1017h", "DefaultValue=111"), ("add", "5F00h", "Speed", "UNSIGNED16", "rw")])
        self.branch("ours", [("set", "1017h", "DefaultValue=222"), ("set", "DeviceInfo", "ProductName=Other")])
        output = self.git("merge", "-q", "--no-edit", "theirs", status=INPUT_HAS_ERRORS)
        self.assertIn("drive.eds: conflict in [1017]", output)
        text = self.drive.read_text(encoding="utf-8")
        section = text[text.index("[1017]"):]
        section = section[:section.index("\n[")]
        self.assertEqual(text.count("<<<<<<<"), 1)
        self.assertIn("<<<<<<< ours\nDefaultValue=222\n=======\nDefaultValue=111\n>>>>>>> theirs\n", section)
        self.assertIn("[5F00]", text)
        self.assertIn("ProductName=Other", text)

    def test_a_changed_object_that_the_other_branch_removes(self) -> None:
        self.branch("theirs", [("remove", "6086h", "--force")])
        self.branch("ours", [("set", "6086h", "ParameterName=Motion")])
        self.git("merge", "-q", "--no-edit", "theirs", status=INPUT_HAS_ERRORS)
        text = self.drive.read_text(encoding="utf-8")
        self.assertEqual(text.count("<<<<<<<"), 1)
        conflict = text[text.index("<<<<<<< ours\n"):text.index(">>>>>>> theirs\n")]
        self.assertEqual(conflict.count("["), 1)
        self.assertIn("[6086]\nParameterName=Motion\n", conflict)
        self.assertTrue(conflict.endswith("\n=======\n"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
