#!/usr/bin/env python3
"""edsc conform with a drive: an enabled drive is not tested with outputs, and nothing is written to it.

    drive_test.py SOURCE_DIR EDSC NODES_DIR [unittest arguments]
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE)]
from bench import LIMIT, NODE_ID, Bench  # noqa: E402

SOURCE_DIR, EDSC, NODES = (Path(argument).resolve() for argument in sys.argv[1:4])
SHEET = SOURCE_DIR / "eds/cpd.eds"
WRONG_USAGE = 2
# Controlwords (CiA 402-2): shutdown, switch on, enable operation; disable voltage
ENABLE, DISABLE = (0x06, 0x07, 0x0F), 0x00


class Drive(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-conform-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.bench = Bench(EDSC, self.folder / "bench")
        self.addCleanup(self.bench.close)
        self.bench.start_node([NODES / "cpd"], ["--node-id", NODE_ID], "pre-operational")

    def edsc(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, command, self.bench.address, str(NODE_ID), *map(str, arguments), "--timeout", "60000ms"],
                              capture_output=True, text=True, timeout=LIMIT)

    def conform(self, *options: str) -> subprocess.CompletedProcess[str]:
        return self.edsc("conform", SHEET, "--log", self.folder / "frames.log", *options)

    def control(self, *words: int) -> None:
        for word in words:
            result = self.edsc("write", "6040h", word, "--type", "u16")
            self.assertEqual(result.returncode, 0, result.stderr)

    def enable(self) -> None:
        subprocess.run([EDSC, "nmt", self.bench.address, "start", str(NODE_ID)], check=True, timeout=LIMIT)
        self.control(*ENABLE)

    def test_an_enabled_drive_is_not_tested_with_what_may_move_it(self) -> None:
        self.enable()
        for options in (("--level", "all"), ("--outputs",), ("--level", "communication", "--application")):
            result = self.conform(*options)
            self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""), options)
            self.assertIn("node 5 is a drive (device type 402) that may move: 6041h:00 is ", result.stderr)
        result = self.conform("--level", "communication", "--only", "2.3")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_drive_that_is_not_enabled_is_tested(self) -> None:
        self.enable()
        self.control(DISABLE)
        result = self.conform("--level", "all", "--only", "5.1")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r"(?s)\n +writes +\w{4}h .* 6040h Controlword")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
