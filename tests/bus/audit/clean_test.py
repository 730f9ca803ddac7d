#!/usr/bin/env python3
"""edsc audit does not report traffic that is correct, and logs whose times are not in order.

    clean_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import sys
import unittest

from audits import Audits, Broken
from plant import Frame, axis, clean, eds_of, supply


def screen_of(frames: list[Frame], differences: bool = False) -> str:
    """As candump -t z, or -t d, shows them."""
    lines, before = [], 0.0
    for frame in sorted(frames, key=lambda frame: frame.ms):
        content = "remote request" if frame.remote else frame.data.hex(" ").upper()
        lines.append(f" ({(frame.ms - before) / 1000:010.6f})  can0  {frame.can_id:03X}   [{len(frame.data)}]  {content}\n")
        before = frame.ms if differences else 0.0
    return "".join(lines)


def asc_of(frames: list[Frame]) -> str:
    lines = ["date Wed Nov 25 10:00:00.000 am 2026\nbase hex  timestamps absolute\n"]
    for frame in sorted(frames, key=lambda frame: frame.ms):
        content = "r" if frame.remote else f"d {len(frame.data)} {frame.data.hex(' ')}"
        lines.append(f"   {frame.ms / 1000:.6f} 1  {frame.can_id:X}             Rx   {content}\n")
    return "".join(lines)


def swapped(log: str, can_id: str, time: str, other: str) -> str:
    """With another time of a line, so that it is before that of the previous line."""
    (line,) = (line for line in log.splitlines() if time in line and f" {can_id} " in line)
    return log.replace(line, line.replace(time, other))


class Times(Audits):
    def rules(self, log: str) -> set[str]:
        (self.folder / "axis.eds").write_text(eds_of(axis()))
        (self.folder / "supply.eds").write_text(eds_of(supply()))
        lines = self.run_edsc("--node", "5=axis.eds", "--node", "6=supply.eds", log=log).stdout.splitlines()
        self.assertRegex(lines[-1], r"^<stdin>: \d+ frames of 2 nodes in 2.910 s: ")
        return {line.rpartition("[")[2].rstrip("]") for line in lines if line.endswith("]")}

    def test_differences_of_candump(self) -> None:
        self.assertEqual(self.rules(screen_of(clean())), set())
        self.assertEqual(self.rules(screen_of(clean(), differences=True)), set())

    def test_frames_slightly_out_of_order_are_not_differences(self) -> None:
        self.assertEqual(self.rules(swapped(screen_of(clean()), "285", "001.021000", "001.019900")), set())
        self.assertEqual(self.rules(swapped(asc_of(clean()), "285", "1.021000", "1.019900")), set())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
