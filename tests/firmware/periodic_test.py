#!/usr/bin/env python3
"""The periodic functions of an application on QEMU: the core sleeps, and wakes for each call.

    periodic_test.py IMAGE [unittest arguments]
"""

from __future__ import annotations

import sys
import time
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from tickless_test import PATIENCE, START, SleepingMachine  # noqa: E402

ENTER_STOPPED = "t00020205"
PERIOD = 0.02  # s


class Periodic(SleepingMachine):
    def setUp(self) -> None:
        self.send(START)
        self.assertIsNotNone(self.next_line(PATIENCE))

    def values_for(self, seconds: float) -> list[int]:
        return [int.from_bytes(bytes.fromhex(line.removeprefix("t1852")), "little") for line in self.lines_for(seconds)]

    def test_is_called_at_its_period_and_the_core_sleeps_in_between(self) -> None:
        self.values_for(0.3)
        before = self.word("wake_ups")
        values = self.values_for(3)
        wake_ups = self.word("wake_ups") - before
        print(f"{len(values)} TPDOs in 3 s, {wake_ups} wake-ups")
        self.assertEqual(values, list(range(values[0], values[0] + len(values))), "each call has sent its value once")
        self.assertGreater(values[0], 100, "start has set 100")
        self.assertGreaterEqual(len(values), 75)
        self.assertLessEqual(len(values), 3 / PERIOD + 10)
        self.assertLessEqual(abs(wake_ups - len(values)), len(values) // 10 + 10)

    def test_does_not_depend_on_the_nmt_state(self) -> None:
        before = self.values_for(0.3)[-1]
        self.send(ENTER_STOPPED)
        self.lines_for(1)
        self.send(START)
        first = self.next_line(PATIENCE)
        self.assertIsNotNone(first)
        self.assertGreater(int.from_bytes(bytes.fromhex(first.removeprefix("t1852")), "little"), before + 20)

    def test_has_several_periods(self) -> None:
        before = self.word("seconds")
        time.sleep(3)
        self.assertIn(self.word("seconds") - before, range(2, 5))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
