#!/usr/bin/env python3
"""A FIFO, a device, a folder or a file without an end in the place of a file: a message at once, wherever it is named. Depfiles
with any path, read by ninja and make.

    special_files_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

import diff_test
from cli_test import EDSC, FINE, SMALL, SOURCE_DIR, WRONG_USAGE, CommandLine

LOG = "(1.0) can0 705#00\n"
AT_ONCE = 60  # seconds, on a busy machine; a FIFO waits without an end
NO_BUS = "socketcand:127.0.0.1:1/vcan0"

# Each use of a file by a command. FILE is the special one.
ON_THE_COMMAND_LINE = (
    ("check", "FILE"),
    ("check", "good.eds", "--options", "FILE"),
    ("check", "good.eds", "--profile", "FILE"),
    ("dump", "FILE"),
    ("format", "FILE"),
    ("format", "FILE", "--concise", "-o", "out.cdcf"),
    ("generate", "FILE", "-o", "out"),
    ("generate", "good.eds", "-o", "out", "--options", "FILE"),
    ("diff", "FILE", "good.eds"),
    ("diff", "good.eds", "FILE"),
    ("document", "FILE"),
    ("document", "good.eds", "--against", "FILE"),
    ("overlay", "apply", "FILE"),
    ("overlay", "from", "FILE", "good.eds", "-o", "new.overlay"),
    ("overlay", "from", "good.eds", "FILE", "-o", "new.overlay"),
    ("network", "check", "FILE"),
    ("network", "generate", "FILE", "-o", "out"),
    ("network", "simulate", "FILE"),
    ("network", "verify", NO_BUS, "FILE"),
    ("decode", "good.log", "--node", "5=FILE"),
    ("audit", "good.log", "--node", "5=good.eds", "--conform", "FILE"),
    ("plot", "good.log", "1017h", "--node", "5=FILE"),
    ("conform", NO_BUS, "5", "FILE"),
    ("conform", NO_BUS, "5", "good.eds", "--deviations", "FILE"),
    ("accept", NO_BUS, "5", "FILE", "-o", "report.html"),
    ("configure", NO_BUS, "5", "FILE"),
    ("configure", NO_BUS, "5", "FILE", "--concise", "--eds", "good.eds"),
    ("save", NO_BUS, "5", "FILE"),
    ("write", NO_BUS, "5", "1017h", "--file", "FILE"),
    ("read", NO_BUS, "5", "1017h", "--eds", "FILE"),
)
LOGS = (("decode", "FILE"), ("audit", "FILE"), ("plot", "FILE", "1017h"))


class SpecialFiles(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.write("good.eds", SMALL)
        self.write("good.log", LOG)
        os.mkfifo(self.folder / "fifo")
        (self.folder / "folder").mkdir()
        with (self.folder / "large").open("wb") as large:
            large.truncate(3 << 30)
        self.kinds = {"fifo": "is a FIFO", "/dev/zero": "is a device", "folder": "Is a directory", "large": "larger than 1 GiB"}

    def refuse(self, message: str, *arguments: str) -> None:
        with self.subTest(command=" ".join(arguments)):
            try:
                result = subprocess.run([EDSC, *arguments], cwd=self.folder, capture_output=True, text=True, errors="replace",
                                        timeout=AT_ONCE, stdin=subprocess.DEVNULL, check=False)
            except subprocess.TimeoutExpired:
                self.fail("waits")
            self.expect(WRONG_USAGE, result, message)

    def test_on_the_command_line(self) -> None:
        for words in ON_THE_COMMAND_LINE:
            for kind, message in self.kinds.items():
                if words != ("check", "FILE") or kind != "folder":  # the files of a folder are checked
                    self.refuse(message, *(word.replace("FILE", kind) for word in words))

    def test_named_by_another_file(self) -> None:
        for kind, message in self.kinds.items():
            for node in ({"eds": kind}, {"dcf": kind}, {"eds": "good.eds", "options": kind}):
                self.write("plant.json", json.dumps({"bit_rate": 500, "nodes": {"a": {"node_id": 5, **node}}}))
                self.refuse(message, "network", "check", "plant.json")
            self.write("change.overlay", f"[Overlay]\nVersion=1\nBase={kind}\n")
            self.refuse(message, "check", "change.overlay")

    def test_beside_the_file(self) -> None:
        """The options file of an EDS."""
        options = self.folder / "good.options.json"
        os.mkfifo(options)
        self.refuse("is a FIFO", "check", "good.eds")
        options.unlink()
        options.mkdir()
        self.refuse("Is a directory", "check", "good.eds")
        options.rmdir()
        templates = self.folder / "templates"
        templates.mkdir()
        os.mkfifo(templates / "pdo.hpp.mustache")
        self.refuse("is a FIFO", "generate", "good.eds", "-o", "out", "--templates", "templates")

    def test_of_a_domain(self) -> None:
        self.write("domain.eds", diff_test.DomainFiles.TEXT.replace("NAME", "fifo"))
        result = subprocess.run([EDSC, "diff", "domain.eds", "domain.eds"], cwd=self.folder, capture_output=True, text=True,
                                timeout=AT_ONCE, check=False)
        self.expect(WRONG_USAGE, result, "cannot read fifo: is a FIFO")

    def test_a_log_comes_from_a_fifo_or_a_pipe_but_not_from_a_device(self) -> None:
        for words in LOGS:
            for kind in ("/dev/zero", "folder"):
                self.refuse(self.kinds[kind], *(word.replace("FILE", kind) for word in words), "--node", "5=good.eds")
        with subprocess.Popen([EDSC, "decode", "fifo", "--node", "5=good.eds"], cwd=self.folder, stdout=subprocess.PIPE, text=True) as decode:
            (self.folder / "fifo").write_text(LOG)
            self.assertIn("boot-up", decode.communicate(timeout=AT_ONCE)[0])
        self.assertIn("boot-up", self.edsc("decode", "-", "--node", "5=good.eds", input=LOG).stdout)

    def test_a_pipe_of_the_shell_is_a_file(self) -> None:
        for command in ("check <(cat good.eds)", "diff good.eds <(cat good.eds)"):
            result = subprocess.run(["bash", "-c", f'"$0" {command}', str(EDSC)], cwd=self.folder, capture_output=True, text=True,
                                    timeout=AT_ONCE, check=False)
            self.expect(FINE, result)
        self.expect(FINE, self.edsc("check", "-", input=SMALL))


class Depfiles(CommandLine):
    """The oracles are ninja and make: a build that depends on the file is up to date, and is not after the file has changed."""

    NAMES = ("a b", " b", "a  b", "a#b", "a$b", "$(x)", "a:b", "a%b", "a\\b", "a\\ b", "a\\\\ b", "a\\\\b", "a[b]", "a,b", "a!b",
             "a@b", "ä", "a{b}", "~a")
    REFUSED = ("a\nb", "a\rb", "a\tb", "a\x01b", "a;b", "a\\#b", "a\\:b")

    def depfile(self, name: str) -> subprocess.CompletedProcess[str]:
        shutil.rmtree(self.output, ignore_errors=True)
        self.output.mkdir()
        self.sheet = self.output / name / "device.eds"
        self.sheet.parent.mkdir()
        self.sheet.write_text(SMALL)
        return subprocess.run([EDSC, "generate", f"{name}/device.eds", "-o", "gen", "--depfile", "out.d", "--depfile-target", "out"],
                              cwd=self.output, capture_output=True, text=True, errors="replace", timeout=600, check=False)

    def build(self, *words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(words, cwd=self.output, capture_output=True, text=True, timeout=600, check=False)

    def touch_sheet(self) -> None:
        later = self.sheet.stat().st_mtime + 3600
        os.utime(self.sheet, (later, later))

    @unittest.skipUnless(shutil.which("ninja") and shutil.which("make"), "ninja and make")
    def test_any_path(self) -> None:
        for name in self.NAMES:
            with self.subTest(name=name):
                self.expect(FINE, self.depfile(name))
                shutil.copy(self.output / "out.d", self.output / "made.d")
                (self.output / "build.ninja").write_text("rule r\n  command = cp made.d out.d && touch out\n  depfile = out.d\n"
                                                         "build out: r\n")
                self.assertEqual(self.build("ninja").returncode, FINE)
                self.assertIn("no work to do", self.build("ninja", "-n").stdout)
                self.touch_sheet()
                self.assertNotIn("no work to do", self.build("ninja", "-n").stdout)

                self.expect(FINE, self.depfile(name))
                (self.output / "Makefile").write_text("all: out\nout:\n\ttouch out\n-include out.d\n")
                self.assertEqual(self.build("make").returncode, FINE)
                self.assertEqual(self.build("make", "-q").returncode, FINE)
                self.touch_sheet()
                self.assertEqual(self.build("make", "-q").returncode, 1)

    def test_a_path_that_they_cannot_read_is_an_error(self) -> None:
        for name in self.REFUSED:
            with self.subTest(name=name):
                self.expect(WRONG_USAGE, self.depfile(name), "a depfile cannot name the file")
                self.assertFalse((self.output / "out.d").exists() or (self.output / "gen").exists())


if __name__ == "__main__":
    assert SOURCE_DIR
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
