#!/usr/bin/env python3
"""edsc audit --network: the measured times of a simulated plant beside the computed bounds of its network file.

    network_times_test.py SOURCE_DIR EDSC LOG_PROGRAMS [unittest arguments]

The expected times are computed here from the frames of the log.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

SOURCE_DIR, EDSC, PROGRAMS = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
LINE = re.compile(r"\((\d+)\.(\d+)\) can0 ([0-9A-F]+)#([0-9A-FR]*)")
SCHEMA = json.loads((SOURCE_DIR / "docs/schema/audit.schema.json").read_text())


class NetworkTimes(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def audit(self, plant: str, *arguments: str) -> str:
        log = subprocess.run([PROGRAMS / f"{plant}_log", "20"], check=True, capture_output=True, text=True).stdout
        # From the last boot-up message on, so that no NMT command interrupts a cycle.
        self.frames = [(int(found[1]) * 1_000_000 + int(found[2]), found[3], found[4]) for found in LINE.finditer(log)]
        begin = max(us for us, can_id, _ in self.frames if can_id == "000") + 2_000_000
        self.frames = [one for one in self.frames if one[0] >= begin]
        (self.folder / "bus.log").write_text("".join(
            f"({us // 1_000_000}.{us % 1_000_000:06}) can0 {can_id}#{data}\n" for us, can_id, data in self.frames))
        result = subprocess.run([EDSC, "audit", "bus.log", "--network", SOURCE_DIR / f"examples/networks/{plant}.json", *arguments],
                                cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return result.stdout

    def network(self, plant: str) -> dict:
        report = json.loads(self.audit(plant, "--format", "json"))
        jsonschema.Draft202012Validator(SCHEMA).validate(report)
        return report["network"]

    def distances(self, can_id: int) -> list[int]:
        times = [us for us, found, _ in self.frames if found == f"{can_id:03X}"]
        return [later - earlier for earlier, later in zip(times, times[1:])]

    def test_cyclic_messages(self) -> None:
        messages = {one["name"]: one for one in self.network("eight_devices")["messages"]}
        for name, period in (("sensor TPDO 1", 100_000), ("sensor heartbeat", 500_000), ("analog_inputs TPDO 2", 1_000_000)):
            with self.subTest(name):
                one, distances = messages[name], self.distances(messages[name]["can_id"])
                self.assertEqual(one["period_us"], period)
                self.assertEqual((one["distance"]["min_us"], one["distance"]["max_us"], one["distance"]["count"]),
                                 (min(distances), max(distances), len(distances)))
                self.assertGreaterEqual(one["response_us"], max(distances) - period)
                self.assertLess(one["response_us"], one["deadline_us"])

    def test_synchronous_messages_are_within_their_bounds(self) -> None:
        network = self.network("twelve_axes")
        pdos = [one for one in network["messages"] if one["after_sync"]]
        self.assertGreaterEqual(len(pdos), 24)
        for one in pdos:
            sync, expected = None, []
            for us, can_id, _ in self.frames:
                if can_id == "080":
                    sync = us
                elif can_id == f"{one['can_id']:03X}" and sync is not None:
                    expected.append(us - sync)
            self.assertEqual(one["response_us"], max(expected), one["name"])
            self.assertTrue(one["within_bound"], one)
        load = network["load_percent"]
        self.assertLess(load["mean"], load["computed_max"])
        self.assertGreater(load["mean"], load["computed_min"] / 2)

    def test_sdo_responses(self) -> None:
        servers = {one["name"]: one for one in self.network("eight_devices")["sdo"]}
        asked, expected = None, []
        for us, can_id, _ in self.frames:
            if can_id == "601":
                asked = us
            elif can_id == "581" and asked is not None:
                expected.append(us - asked)
                asked = None
        self.assertGreater(len(expected), 0)
        self.assertEqual((servers["digital_outputs"]["response"]["count"], servers["digital_outputs"]["response"]["max_us"]),
                         (len(expected), max(expected)))
        self.assertEqual(servers["digital_outputs"]["timeout_us"], 500_000)

    def test_text_and_page(self) -> None:
        self.assertNotIn("bound", self.audit("four_modules"))
        text = self.audit("four_modules", "--times")
        self.assertRegex(text, r"(?m)^load: [\d.]+ % measured, at most [\d.]+ % over 100 ms; [\d.]+ to [\d.]+ % computed$")
        self.assertRegex(text, r"(?m)^digital_inputs heartbeat +702h ")
        page = self.audit("four_modules", "--format", "html")
        self.assertIn("digital_inputs heartbeat", page)
        self.assertIn("Measured and computed times", page)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
