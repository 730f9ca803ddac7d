#!/usr/bin/env python3
"""The ELF file of the program has the options that make errors in it harder to exploit.

    hardening_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

EDSC = Path(sys.argv[2]).resolve()


@unittest.skipUnless(shutil.which("readelf"), "SKIPPED: no readelf")
class Hardening(unittest.TestCase):
    def readelf(self, *options: str) -> str:
        return subprocess.run(["readelf", "--wide", *options, EDSC], capture_output=True, text=True, check=True).stdout

    def test_is_position_independent(self) -> None:
        self.assertRegex(self.readelf("--file-header"), r"Type: +DYN")
        self.assertRegex(self.readelf("--dynamic"), r"FLAGS_1.*\bPIE\b")

    def test_relocations_are_read_only(self) -> None:
        self.assertIn("GNU_RELRO", self.readelf("--program-headers"))
        self.assertRegex(self.readelf("--dynamic"), r"FLAGS_1.*\bNOW\b")

    def test_the_stack_is_not_executable(self) -> None:
        self.assertRegex(self.readelf("--program-headers"), r"GNU_STACK.* RW +0x")

    def test_stack_and_library_calls_are_checked(self) -> None:
        symbols = set(re.findall(r"UND (\w+)", self.readelf("--dyn-syms")))
        self.assertIn("__stack_chk_fail", symbols)
        self.assertTrue([name for name in symbols if name.endswith("_chk")], "no fortified function of the C library")

    def test_indirect_branches_have_marked_targets(self) -> None:
        """CET of x86: main is a target. The file has the note only if the start-up code of the C library has it."""
        if "X86-64" not in self.readelf("--file-header") or not shutil.which("objdump"):
            print("SKIPPED: not x86-64, or no objdump")
            self.skipTest("SKIPPED: not x86-64")
        code = subprocess.run(["objdump", "--disassemble=main", "--no-show-raw-insn", EDSC], capture_output=True, text=True,
                              check=True).stdout
        self.assertRegex(code, r"<main>:\n.*endbr64")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)
