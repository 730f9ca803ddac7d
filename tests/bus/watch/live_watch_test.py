#!/usr/bin/env python3
"""edsc watch on a bus: frames that python-can sends raise the same alarms as the log of these frames.

    live_watch_test.py SOURCE_DIR EDSC LOG_PROGRAMS [unittest arguments]

The frames are those of a simulated plant, in real time, with planted faults.
"""

from __future__ import annotations

import json
import logging
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import can

SOURCE_DIR, EDSC, PROGRAMS = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
PLANT = SOURCE_DIR / "examples/networks/four_modules.json"
LINE = re.compile(r"\((\d+\.\d+)\) can0 ([0-9A-F]+)#([0-9A-F]*)")
SECONDS = 6  # of normal operation
# In the last seconds; none of them depends on times that a busy computer changes.
PLANTED = ((-4.0, "000#0200"), (-3.5, "7E5#0401000000000000"), (-3.0, "601#2B17100000000000"), (-2.5, "183#00"), (-2.0, "18FF0001#01"),
           (-1.5, "709#05"))
EXPECTED = [("nmt-command", None), ("lss-command", None), ("sdo-write", "digital_outputs"), ("pdo-length", "analog_outputs"),
            ("can-id-unknown", None), ("node-unknown", None)]
# The times of a busy computer are not those of the plant.
LATE = {"pdo-rate", "pdo-missing", "node-duplicate", "bus-load", "node-missing", "bus-silent", "pdo-state"}


class LiveWatch(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bus = subprocess.Popen([EDSC, "bus", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        self.addCleanup(bus.stdout.close)
        self.addCleanup(bus.wait)
        self.addCleanup(bus.terminate)
        self.address = re.search(r"socketcand:([^:]+):(\d+)/(\w+)", bus.stdout.readline())
        logging.getLogger("can.interfaces.socketcand").setLevel(logging.ERROR)

    def frames(self) -> list[tuple[float, str, str]]:
        text = subprocess.run([PROGRAMS / "four_modules_log", str(SECONDS)], check=True, capture_output=True, text=True).stdout
        frames = [(float(found[1]), found[2], found[3]) for found in LINE.finditer(text)]
        end = frames[-1][0]
        frames += [(end + after, *frame.split("#")) for after, frame in PLANTED]
        return sorted(frames)

    def alarms(self, text: str) -> list[tuple[str, str | None]]:
        found = [json.loads(line) for line in text.splitlines()]
        return [(one["alarm"], one["node"]) for one in found if one["alarm"] not in LATE]

    def test_raises_the_alarms_of_the_log(self) -> None:
        frames = self.frames()
        log = "".join(f"({at:.6f}) can0 {can_id}#{data}\n" for at, can_id, data in frames)
        replayed = subprocess.run([EDSC, "watch", "-", "--network", PLANT, "--format", "json"], input=log, capture_output=True, text=True)
        self.assertEqual(self.alarms(replayed.stdout), EXPECTED, replayed.stderr)
        command = 'echo "$EDSC_ALARM" >> commands.txt'
        watch = subprocess.Popen([EDSC, "watch", self.address[0], "--network", PLANT, "--format", "json", "--run", command,
                                  "--exit-on", "node-unknown"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(watch.communicate)
        self.addCleanup(watch.kill)
        bus = can.Bus(interface="socketcand", host=self.address[1], port=int(self.address[2]), channel=self.address[3])
        self.addCleanup(bus.shutdown)
        time.sleep(2)  # until the watch has connected
        first, begin = frames[0][0], time.monotonic()
        for at, can_id, data in frames:
            time.sleep(max(0.0, at - first - (time.monotonic() - begin)))
            bus.send(can.Message(arbitration_id=int(can_id, 16), is_extended_id=len(can_id) > 3, data=bytes.fromhex(data)))
        output, error = watch.communicate(timeout=120)
        self.assertEqual((self.alarms(output), watch.returncode), (EXPECTED, 1), error)
        commands = [one for one in (self.folder / "commands.txt").read_text().split() if one not in LATE]
        self.assertEqual(commands, [alarm for alarm, _ in EXPECTED])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
