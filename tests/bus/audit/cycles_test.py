#!/usr/bin/env python3
"""The cycle times of edsc audit: numbers, nominal times, and what ends a cycle.

    cycles_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import sys
import unittest
from statistics import fmean, pstdev

from audits import Audits, Broken
from plant import START_MS, STOP_MS, SYNC_PERIOD_MS, Frame, axis, clean, sdo, supply


def late(log: list[Frame], can_id: int, delays: tuple[float, ...]) -> list[Frame]:
    """With these delays, in turn, of the frames of a CAN-ID in ms."""
    frames = sorted((frame for frame in log if frame.can_id == can_id and not frame.remote), key=lambda frame: frame.ms)
    moved = [Frame(frame.ms + delays[at % len(delays)], can_id, frame.data) for at, frame in enumerate(frames)]
    return [frame for frame in log if frame not in frames] + moved


class Cycles(Audits):
    def cycles(self, case: Broken, *arguments: str) -> list[dict]:
        return self.report(case, *arguments)["cycles"]

    def one(self, case: Broken, subject: str) -> dict:
        (cycle,) = (one for one in self.cycles(case) if one["subject"] == subject)
        return cycle

    def test_nominal_times(self) -> None:
        nominal = {one["subject"]: (one["nominal_us"], one["index"]) for one in self.cycles(Broken())}
        self.assertEqual(nominal, {
            "SYNC of node 6": (50_000, "1006h:00"), "node 5 heartbeat": (100_000, "1017h:00"), "node 6 heartbeat": (100_000, "1017h:00"),
            "node 5 TPDO 1": (100_000, "1800h:05"), "node 5 TPDO 2": (50_000, "1801h:02"), "node 5 TPDO 3": (None, None),
            "node 5 RPDO 1": (None, None)})

    def test_numbers(self) -> None:
        delays = (0.0, 2.5, 1.25, 0.0, 4.0)
        log = late(clean(), 0x185, delays)
        times = sorted(round(frame.ms * 1000) for frame in log if frame.can_id == 0x185)
        gaps = [after - before for before, after in zip(times, times[1:])]
        cycle = self.one(Broken(lambda _: log), "node 5 TPDO 1")
        self.assertEqual((cycle["frames"], cycle["can_id"], cycle["number"]), (len(times), 0x185, 1))
        distance = cycle["distance"]
        self.assertEqual((distance["count"], distance["min_us"], distance["max_us"]), (len(gaps), min(gaps), max(gaps)))
        self.assertEqual(distance["jitter_us"], max(gaps) - min(gaps))
        self.assertAlmostEqual(distance["mean_us"], fmean(gaps), places=3)
        self.assertAlmostEqual(distance["deviation_us"], pstdev(gaps), places=3)

    def test_delay_after_sync(self) -> None:
        delays = self.one(Broken(lambda log: late(log, 0x285, (0.0, 3.0))), "node 5 TPDO 2")["after_sync"]
        self.assertEqual((delays["min_us"], delays["max_us"], delays["jitter_us"]), (1000, 4000, 3000))
        self.assertEqual(delays["count"], len(range(20, STOP_MS, SYNC_PERIOD_MS)) - len(range(20, START_MS + 1, SYNC_PERIOD_MS)))
        self.assertIsNone(self.one(Broken(), "node 5 TPDO 1")["after_sync"])

    def test_a_changed_parameter_begins_another_cycle(self) -> None:
        def slower(log: list[Frame]) -> list[Frame]:
            log = [one for one in log if one.can_id != 0x705 or one.ms < 1100 or (one.ms - 10) % 200 == 0]
            return [*log, *sdo(1100, 5, "2B171000C8000000", "6017100000000000")]
        cycles = [one for one in self.cycles(Broken(slower)) if one["subject"] == "node 5 heartbeat"]
        self.assertEqual([(one["nominal_us"], one["distance"]["min_us"], one["distance"]["max_us"]) for one in cycles],
                         [(100_000, 100_000, 100_000), (200_000, 200_000, 200_000)])

    def test_stop_and_start_do_not_make_a_cycle(self) -> None:
        def stopped(log: list[Frame]) -> list[Frame]:
            log = [one for one in log if one.can_id not in (0x185, 0x285) or not 1300 < one.ms < 1900]
            log = [Frame(one.ms, one.can_id, b"\x7F") if one.can_id == 0x705 and 1305 < one.ms < 1900 else one for one in log]
            return [*log, Frame(1303, 0x000, b"\x80\x05"), Frame(1899, 0x000, b"\x01\x05")]
        self.assertEqual(self.one(Broken(stopped), "node 5 TPDO 1")["distance"]["max_us"], 100_000)

    def test_sync_of_a_node_that_is_not_known(self) -> None:
        cycle = self.one(Broken(supply=supply(i1005="0x80")), "SYNC")
        self.assertEqual((cycle["node_id"], cycle["nominal_us"], cycle["distance"]["mean_us"]), (None, None, 50_000))

    def test_a_log_without_times_has_no_cycles(self) -> None:
        self.assertEqual(self.audit(Broken()).returncode, 0)  # writes the EDS
        log = "".join(f"can0 {frame.can_id:03X}#{frame.data.hex()}\n" for frame in clean() if not frame.remote)
        report = self.run_edsc("--node", "5=axis.eds", "--cycles", log=log).stdout
        self.assertNotIn("cycle times", report)

    def test_text(self) -> None:
        table = self.audit(Broken(), "--cycles").stdout.partition("\n\n")[2].splitlines()
        self.assertEqual(table[0].split(), "cycle times in ms CAN-ID frames nominal stated by min mean max jitter std dev".split())
        self.assertEqual(table[1].split(), "SYNC of node 6 080h 50 50.000 1006h:00 50.000 50.000 50.000 0.000 0.000".split())
        self.assertEqual(self.audit(Broken(axis=axis())).stdout.count("\n"), 1)

    def test_html(self) -> None:
        page = self.audit(Broken(), "--format", "html").stdout
        self.assertIn('<td class="text">node 5 TPDO 2</td><td class="fixed mono">285h</td>', page)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
