#!/usr/bin/env python3
""".ci/progress, which demo.sh and test.sh use: what is done, and the time that is left.

    progress_test.py SOURCE_DIR [unittest arguments]
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
BUILD = "".join(f"[{step}/10] Building {step}\n" for step in range(11))
TESTS = "Test project /build\n    Start 1: slow\n1/2 Test #1: slow ....   Passed    9.00 sec\n2/2 Test #2: fast ....   Passed    0.00 sec\n"
TIMES = '<testcase name="slow" classname="slow" time="97.5" status="run">\n<testcase name="fast" classname="fast" time="1.5" status="run">\n'


def progress(text: str, *arguments: str) -> list[str]:
    return subprocess.run([SOURCE_DIR / ".ci/progress", *arguments], input=text, capture_output=True, text=True, check=True,
                          timeout=60).stdout.splitlines()


class Progress(unittest.TestCase):
    def test_build(self) -> None:
        lines = [line for line in progress(BUILD, "test", "100", "80") if line.startswith("test: ")]
        self.assertEqual(lines[0], "test: build 0 of 10 steps, about 3 min left")
        self.assertEqual(lines[-1], "test: build 10 of 10 steps, about 80 s left")

    def test_output_is_passed_on_or_logged(self) -> None:
        self.assertEqual([line for line in progress(BUILD + TESTS, "test", "100", "80") if not line.startswith("test: ")],
                         (BUILD + TESTS).splitlines())
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder) / "log"
            self.assertTrue(all(line.startswith("test: ") for line in progress(BUILD + TESTS, "--log", str(log), "test", "100", "80")))
            self.assertEqual(log.read_text(encoding="utf-8"), BUILD + TESTS)

    def test_times_of_tests_are_those_of_the_last_run(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            times = Path(folder) / "times.xml"
            times.write_text(TIMES, encoding="utf-8")
            lines = [line for line in progress(TESTS, "test", "0", "100", str(times)) if line.startswith("test: ")]
        self.assertEqual(lines, ["test: tests 1 of 2, about 0 s left", "test: tests 2 of 2, about 0 s left"])

    def test_without_times_each_test_counts_the_same(self) -> None:
        lines = [line for line in progress(TESTS, "test", "0", "100") if line.startswith("test: ")]
        self.assertEqual(lines, ["test: tests 1 of 2, about 25 s left", "test: tests 2 of 2, about 0 s left"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
