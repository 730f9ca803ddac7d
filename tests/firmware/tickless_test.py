#!/usr/bin/env python3
"""examples/tickless_firmware on QEMU: frames from the UART's interrupt and values from a timer's interrupt reach the node, and
the core sleeps unless there is work.

    tickless_test.py IMAGE [unittest arguments]
"""

from __future__ import annotations

import os
import select
import subprocess
import sys
import tempfile
import time
import tty
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from machine import Machine  # noqa: E402

IMAGE = Path(sys.argv[1])
PATIENCE = 20.0  # s, for a response
HEARTBEAT = "t70517F"
STOP_HEARTBEAT, HEARTBEAT_100_MS = "t60582B17100000000000", "t60582B17100064000000"
CONFIRMED = "t58586017100000000000"
START, ENTER_PRE_OPERATIONAL = "t00020105", "t00028005"


def address_of(symbol: str) -> int:
    symbols = subprocess.run(["arm-none-eabi-nm", IMAGE], check=True, capture_output=True, text=True).stdout
    return next(int(line.split()[0], 16) for line in symbols.splitlines() if line.split()[-1] == symbol)


class SleepingMachine(unittest.TestCase):
    """A firmware that counts in `wake_ups` how often its core has slept."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.machine = Machine("mps2-an385", IMAGE, Path(cls.folder.name))
        cls.machine.power_on()
        cls.text = b""
        tty.setraw(cls.machine.line)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.machine.power_off()
        cls.folder.cleanup()

    def send(self, *lines: str) -> None:
        os.write(self.machine.line, "".join(line + "\r" for line in lines).encode())

    def next_line(self, seconds: float) -> str | None:
        """Returns the next line of the firmware; None if there is none in this time."""
        end = time.monotonic() + seconds
        while b"\r" not in self.text:
            ready, _, _ = select.select([self.machine.line], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                return None
            type(self).text += os.read(self.machine.line, 4096)
        line, _, rest = self.text.partition(b"\r")
        type(self).text = rest
        return line.decode()

    def lines_for(self, seconds: float) -> list[str]:
        end = time.monotonic() + seconds
        lines = []
        while (line := self.next_line(end - time.monotonic())) is not None:
            lines.append(line)
        return lines

    def ask(self, request: str, response: str) -> None:
        """The serial line of QEMU may lose what is sent in the first second."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            self.send(request)
            limit = time.monotonic() + 2
            while (line := self.next_line(limit - time.monotonic())) is not None:
                if line == response:
                    return
        self.fail(f"no response {response}")

    def words(self, symbol: str, count: int) -> list[int]:
        """Returns the values of a variable of the firmware that has this number of words of 32 bits."""
        read = self.machine.save(address_of(symbol), 4 * count, Path(self.folder.name) / "words")
        return [int.from_bytes(read[i : i + 4], "little") for i in range(0, 4 * count, 4)]


class Tickless(SleepingMachine):
    def wake_ups(self) -> int:
        return self.words("wake_ups", 1)[0]

    def setUp(self) -> None:
        self.send(ENTER_PRE_OPERATIONAL)
        self.ask(STOP_HEARTBEAT, CONFIRMED)
        self.lines_for(0.3)

    def test_sleeps_without_work(self) -> None:
        before = self.wake_ups()
        self.assertEqual(self.lines_for(2), [])
        self.assertLessEqual(self.wake_ups() - before, 1)

    def test_wakes_once_for_each_heartbeat(self) -> None:
        self.ask(HEARTBEAT_100_MS, CONFIRMED)
        self.lines_for(0.3)
        before = self.wake_ups()
        lines = self.lines_for(3)
        wake_ups = self.wake_ups() - before
        print(f"{len(lines)} heartbeats, {wake_ups} wake-ups")
        self.assertEqual(set(lines), {HEARTBEAT})
        self.assertGreaterEqual(len(lines), 15)
        self.assertLessEqual(abs(wake_ups - len(lines)), 2)

    def test_answers_each_of_many_requests_at_once(self) -> None:
        """The interrupt receives faster than the loop answers: nothing is lost."""
        requests = [f"t60582F0020{i:02X}00000000" for i in range(24)]  # a byte to 2000h:i, a VAR of 16 bits: all are aborted
        self.send(*requests)
        lines = []
        while len(lines) < len(requests) and (line := self.next_line(PATIENCE)) is not None:
            lines.append(line)
        self.assertEqual([line[:13] for line in lines], [f"t5858800020{i:02X}" for i in range(24)])

    def test_values_of_an_interrupt_are_transmitted(self) -> None:
        self.send(START)
        self.assertIsNotNone(self.next_line(PATIENCE))
        self.lines_for(0.3)
        before = self.wake_ups()
        lines = self.lines_for(3)
        wake_ups = self.wake_ups() - before
        print(f"{len(lines)} TPDOs, {wake_ups} wake-ups")
        values = [int.from_bytes(bytes.fromhex(line.removeprefix("t1852")), "little") for line in lines]
        self.assertGreaterEqual(len(values), 30)
        self.assertEqual(values, list(range(values[0], values[0] + len(values))))
        self.assertLessEqual(abs(wake_ups - len(lines)), 2)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
