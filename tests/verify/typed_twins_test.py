#!/usr/bin/env python3
"""Typed values need no more flash and instructions than masks and numbers by hand.

    typed_twins_test.py SOURCE_DIR EDSC

Compiles bench/footprint/twins.cpp for a Cortex-M0+ and a Cortex-M4, at -Os and at -O2, and compares each pair of functions.
"""

from __future__ import annotations

import shutil
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv.pop(1)).resolve()
EDSC = Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(SOURCE / "bench/footprint"))
import twins  # noqa: E402

# One instruction more in 4 bytes less: a multiplication and an addition in place of a constant that is loaded.
ACCEPTED = {("M4 -Os", "convert")}


class TypedTwins(unittest.TestCase):
    def test_no_typed_twin_is_larger(self) -> None:
        if shutil.which(twins.COMPILER[0]) is None:
            self.skipTest("no compiler for Arm")
        for target, flags in twins.TARGETS.items():
            found = twins.sizes(EDSC, SOURCE / "runtime/include", flags)
            for name in twins.ROWS:
                typed, by_hand = found[f"typed_{name}"], found[f"hand_{name}"]
                with self.subTest(target=target, name=name):
                    self.assertGreater(by_hand.bytes, 0)
                    self.assertLessEqual(typed.bytes, by_hand.bytes)
                    if (target, name) not in ACCEPTED:
                        self.assertLessEqual(typed.instructions, by_hand.instructions)


if __name__ == "__main__":
    unittest.main()
