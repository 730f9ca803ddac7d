#!/usr/bin/env python3
"""The periodic functions of an application on QEMU: the core sleeps, and wakes for each call.

    periodic_test.py IMAGE [unittest arguments]
"""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent))
from tickless_test import PATIENCE, START, SleepingMachine  # noqa: E402

ENTER_STOPPED = "t00020205"
CALLS_PER_SECOND = 50


class Counters(NamedTuple):
    starts: int
    wake_ups: int
    calls: int
    seconds: int


class Periodic(SleepingMachine):
    def setUp(self) -> None:
        self.send(START)
        self.assertIsNotNone(self.next_line(PATIENCE))

    def values_for(self, seconds: float) -> list[int]:
        return [int.from_bytes(bytes.fromhex(line.removeprefix("t1852")), "little") for line in self.lines_for(seconds)]

    def counters(self) -> Counters:
        return Counters(*self.words("counters", len(Counters._fields)))

    def test_is_called_at_its_periods_and_the_core_sleeps_in_between(self) -> None:
        """The clock of the board may differ from that of a busy computer: its counters are compared with each other."""
        self.values_for(0.3)
        before = self.counters()
        values = self.values_for(5)
        passed = Counters(*(after - then for after, then in zip(self.counters(), before)))
        print(f"{len(values)} TPDOs, {passed}")
        self.assertEqual(values, list(range(values[0], values[0] + len(values))), "each call has sent its value once")
        self.assertEqual((before.starts, passed.starts), (1, 0))
        self.assertGreater(passed.seconds, 1)
        self.assertLessEqual(passed.calls, CALLS_PER_SECOND * (passed.seconds + 1))
        self.assertGreaterEqual(passed.calls, CALLS_PER_SECOND * (passed.seconds - 1) // 2, "some may be late")
        self.assertLessEqual(abs(passed.wake_ups - passed.calls), passed.calls // 10 + 5)

    def test_does_not_depend_on_the_nmt_state(self) -> None:
        while not (values := self.values_for(0.3)):  # on a busy computer
            pass
        before = values[-1]
        self.send(ENTER_STOPPED)
        self.lines_for(1)
        self.send(START)
        first = self.next_line(PATIENCE)
        self.assertIsNotNone(first)
        self.assertGreater(int.from_bytes(bytes.fromhex(first.removeprefix("t1852")), "little"), before + 20)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
