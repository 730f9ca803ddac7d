#!/usr/bin/env python3
"""edsc record with live nodes on the virtual bus of `edsc bus`.

    record_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import select
import shutil
import signal
import subprocess
import time

from live import EDSC, FAILED, FINE, WRONG_USAGE, LiveTest, run


class Record(LiveTest):
    nodes = ()

    def wait_until_it_records(self, process: subprocess.Popen[str]) -> None:
        """Sends frames until edsc record has written one."""
        client = self.network.client()
        while not select.select([process.stdout], [], [], 0.1)[0]:
            client.send("701 05")

    def test_it_writes_lines_of_candump(self) -> None:
        process = self.start("record", "--count", 5)
        self.wait_until_it_records(process)
        client = self.network.client()
        for frame in ("605 40 00 10 00 00 00 00 00", "080", "701 05", "701 05", "701 05"):
            client.send(frame)
        stdout, stderr = process.communicate(timeout=600)
        self.assertEqual((process.returncode, stderr), (FINE, ""))
        lines = stdout.splitlines()
        self.assertEqual(len(lines), 5)
        for line in lines:
            self.assertRegex(line, r"^\(\d{10}\.\d{6}\) vcan0 [0-9A-F]{3}#[0-9A-F]*$")
        times = [float(line[1:18]) for line in lines]
        self.assertEqual(times, sorted(times))

    def test_its_file_is_one_for_decode_and_can_utils(self) -> None:
        process = self.start("record", "-o", "bus.log", "--log-interface", "can7")
        client, log = self.network.client(), self.folder / "bus.log"
        while not log.exists() or not log.stat().st_size:
            client.send("605 40 00 10 00 00 00 00 00")
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=600)
        count = len(log.read_text().splitlines())
        self.assertEqual((stdout, stderr, process.returncode), (f"{count} frames written to bus.log\n", "", FINE))
        decoded = subprocess.run([EDSC, "decode", log], capture_output=True, text=True, timeout=60)
        self.assertEqual(decoded.returncode, FINE)
        self.assertEqual(len(decoded.stdout.splitlines()), count)
        if shutil.which("log2asc"):
            ascii_log = subprocess.run(["log2asc", "-I", log, "can7"], capture_output=True, text=True, timeout=60)
            self.assertEqual((ascii_log.returncode, ascii_log.stdout.count(" 605 ")), (0, count), ascii_log)

    def test_it_ends_after_its_time(self) -> None:
        self.expect(self.edsc("record", "--for", "0.05s"), FINE)

    def test_a_full_disk(self) -> None:
        process = self.start("record", "-o", "/dev/full")
        client = self.network.client()
        while process.poll() is None:
            client.send("701 05")
            time.sleep(0.05)
        self.assertEqual((process.returncode, process.stderr.read()),
                         (WRONG_USAGE, "edsc: /dev/full: No space left on device\n"))

    def test_the_bus_goes_away(self) -> None:
        process = self.start("record")
        self.wait_until_it_records(process)
        self.network.bus.kill()
        _, stderr = process.communicate(timeout=600)
        self.assertEqual(process.returncode, FAILED)
        self.assertIn(": the bus is lost: ", stderr)

    def test_wrong_usage(self) -> None:
        for arguments in (("--count", 0), ("--for", "0s"), ("--log-interface", "a b"), ("-o", "no/such/folder/log")):
            self.assertEqual(self.edsc("record", *arguments).returncode, WRONG_USAGE, arguments)


if __name__ == "__main__":
    run()
