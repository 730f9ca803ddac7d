#!/usr/bin/env python3
"""edsc conform is interrupted, or loses its device, while a case has changed the device.

    interruption_test.py SOURCE_DIR EDSC NODES_DIR [unittest arguments]

The values of the device are read over SDO before and after that.
"""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "cli/live")]
from bench import LIMIT, NODE_ID, TRIES, Bench  # noqa: E402
from network import Client  # noqa: E402

SOURCE_DIR, EDSC, NODES = (Path(argument).resolve() for argument in sys.argv[1:4])
SHEET = SOURCE_DIR / "eds/can-2053c.eds"
FAILED, INTERRUPTED = 1, 130
HEARTBEAT = "705 7F"
# The run finds the state of the node with heartbeats of 100 ms, and case 7.102 writes the same again. Then the case waits.
IN_7_102 = ("605 2B 17 10 00 64 00", "605 2B 17 10 00 64 00", HEARTBEAT, HEARTBEAT, HEARTBEAT)


class Interruption(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        folder = Path(tempfile.mkdtemp(prefix="edsc-conform-"))
        self.addCleanup(shutil.rmtree, folder)
        self.report = folder / "report.json"
        self.bench = Bench(EDSC, folder / "bench")
        self.addCleanup(self.bench.close)
        self.node = self.bench.start_node([NODES / "can_2053c"], ["--node-id", NODE_ID], "pre-operational")
        self.client = Client(int(re.search(r":(\d+)/", self.bench.address)[1]))
        self.addCleanup(self.client.close)

    def edsc(self, command: str, *arguments: object) -> str:
        result = subprocess.run([EDSC, command, self.bench.address, str(NODE_ID), *map(str, arguments), "--timeout", "60000ms"],
                                capture_output=True, text=True, timeout=LIMIT)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def values(self) -> str:
        return self.edsc("read", "1017h", "1800h:01", "1800h:02", "1800h:03", "1800h:05", *(f"1A00h:0{i}" for i in range(3)))

    def start(self, case: str, frames: tuple[str, ...], timeout_ms: int = 2000) -> subprocess.Popen[str]:
        """Starts edsc conform and waits until these frames were on the bus in this order."""
        command = self.bench.command(SHEET, self.report, f"--only={case}", timeout_ms=timeout_ms)
        process = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        for frame in frames:
            while not self.client.receive().startswith(frame):
                pass
        return process

    def check_interrupted(self, case: str, *frames: str) -> None:
        self.edsc("write", "1017h", 2000, "--type", "u16")
        before = self.values()
        for _ in range(TRIES):  # on a busy computer the run may end before the signal
            process = self.start(case, frames)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=LIMIT)
            if process.returncode != 0:
                break
        self.assertEqual(process.returncode, INTERRUPTED)
        self.assertEqual(self.values(), before)
        report = json.loads(self.report.read_text(encoding="utf-8"))
        self.assertTrue(report["interrupted"])
        self.assertFalse(report["passed"])
        self.assertEqual(report["not_restored"], [])

    def state(self) -> str:
        """Returns the next heartbeat."""
        last = Client(self.client.socket.getpeername()[1])
        try:
            while not (frame := last.receive()).startswith("705"):
                pass
            return frame
        finally:
            last.close()

    def test_with_1017h_written(self) -> None:
        self.check_interrupted("7.102", *IN_7_102)

    def test_with_a_mapping_written(self) -> None:
        self.check_interrupted("3.22", "605 23 00 1A")

    def test_in_another_nmt_state(self) -> None:
        self.check_interrupted("3.5", "000 01 05")
        self.assertEqual(self.state(), "705 7F")

    def test_the_device_is_gone(self) -> None:
        process = self.start("7.102", IN_7_102)
        self.node.kill()
        stdout, stderr = process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, FAILED, stdout + stderr)
        text = "1017h:00 Producer Heartbeat Time: the device does not answer"
        self.assertIn(text.lower(), stdout.lower())
        report = json.loads(self.report.read_text(encoding="utf-8"))
        self.assertEqual([left.lower() for left in report["not_restored"]], [text.lower()])

    def test_the_second_signal_ends_at_once(self) -> None:
        process = self.start("7.102", IN_7_102, timeout_ms=600_000)
        self.node.kill()
        self.node.wait(LIMIT)
        process.send_signal(signal.SIGINT)
        while not self.client.receive().startswith("605 40 17 10"):  # it restores values and waits for an answer
            pass
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LIMIT)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertFalse(self.report.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
