#!/usr/bin/env python3
"""edsc monitor with live nodes on the virtual bus of `edsc bus`.

    monitor_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import time

from live import FINE, WRONG_USAGE, LiveTest, run


class Monitor(LiveTest):
    nodes = (5, 6)

    def setUp(self) -> None:
        super().setUp()
        self.edsc("write", 5, "1017h", 40, "--type", "u16")

    def test_a_summary_as_json(self) -> None:
        self.edsc("write", 5, "1017h", 200, "--type", "u16")
        process = self.start("monitor", "--node", "5=device.eds", "--once", "15s", "--bit-rate", 125, "--format", "json")
        time.sleep(4)  # until it receives frames
        self.edsc("nmt", "start", 5)
        client = self.network.client()
        client.send("086 30 81 11 00 00 00 00 00")
        client.send("123 01")
        stdout, stderr = process.communicate(timeout=600)
        found = self.expect_json(subprocess.CompletedProcess([], process.returncode, stdout, stderr), "monitor.schema.json")
        drive, other = found["nodes"]
        self.assertEqual((drive["node_id"], drive["name"], drive["state"], drive["late"]), (5, "Live device", "operational", False))
        self.assertGreater(drive["heartbeats"], 8)
        self.assertEqual((other["node_id"], other["emergencies"], other["last_emergency"]["code"]), (6, 1, 0x8130))
        self.assertEqual([(pdo["node_id"], pdo["direction"], pdo["number"], pdo["values"]) for pdo in found["pdos"]], [
            (5, "transmit", 1, [{"name": "Statusword", "text": found["pdos"][0]["values"][0]["text"]},
                                {"name": "Position actual value", "text": "123456 inc"}])])
        self.assertEqual([(other["cob_id"], other["frames"]) for other in found["others"]], [(0x123, 1)])
        self.assertGreater(found["load_percent"], 0)

    def test_a_summary_as_a_table(self) -> None:
        result = self.edsc("monitor", "--once", "3s", "--node", "5=device.eds")
        lines = result.stdout.splitlines()
        self.assertRegex(lines[0], r"^socketcand:\S+  \d+\.\d s  \d+ frames  \d+\.\d per s$")
        self.assertEqual(lines[2], "node  name         state            heard  last EMCY")
        self.assertRegex(lines[3], r"^   5  Live device  pre-operational  \d\.\d s( late)?  -$")
        self.assertNotIn("\x1b", result.stdout)

    def test_a_line_for_each_change(self) -> None:
        self.edsc("write", 5, "1017h", 1000, "--type", "u16")
        process = self.start("monitor", "--node", "5=device.eds")
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  HEART     node 5 .*pre-operational")
        self.edsc("nmt", "start", 5)
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  NMT       node 5 .*start")
        rest = process.stdout.readline() + process.stdout.readline()
        self.assertIn("Position actual value = 123456 inc", rest)
        self.assertRegex(rest, r"(?<!pre-)operational")
        process.send_signal(signal.SIGINT)
        self.assertEqual((process.wait(timeout=600), process.stdout.read()), (FINE, ""))

    def test_the_table_on_a_terminal(self) -> None:
        terminal, inside = pty.openpty()
        self.addCleanup(os.close, terminal)
        resize = lambda rows, columns: fcntl.ioctl(inside, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        resize(10, 60)
        before = termios.tcgetattr(inside)
        process = subprocess.Popen(self.command("monitor", "--node", "5=device.eds"), cwd=self.folder, stdin=inside,
                                   stdout=inside, stderr=inside, env={**os.environ, "NO_COLOR": "1"})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        def shown_until(wanted: str) -> str:
            shown, end = "", time.monotonic() + 120
            while wanted not in shown and time.monotonic() < end:
                if select.select([terminal], [], [], 0.1)[0]:
                    shown += os.read(terminal, 65536).decode()
            self.assertIn(wanted, shown)
            return shown

        shown = shown_until("pre-operational")
        self.assertTrue(shown.startswith("\x1b[?1049h\x1b[?25l\x1b[H"), repr(shown[:40]))
        for line in re.split(r"\r+\n|\x1b\[H", shown):
            self.assertLessEqual(len(re.sub(r"\x1b\[[^a-zA-Z]*[a-zA-Z]", "", line)), 60)
        self.assertNotEqual(termios.tcgetattr(inside)[3], before[3])
        resize(3, 40)
        shown_until("more lines")
        os.write(terminal, b"q")
        self.assertTrue(shown_until("\x1b[?1049l").endswith("\x1b[?25h\x1b[?1049l"))
        self.assertEqual(process.wait(timeout=600), FINE)
        self.assertEqual(termios.tcgetattr(inside), before)
        os.close(inside)

    def test_wrong_usage(self) -> None:
        for arguments in (("--node", "5"), ("--node", "0=device.eds"), ("--format", "json"), ("--once", "0s"),
                          ("--node", "5=missing.eds")):
            self.assertEqual(self.edsc("monitor", *arguments).returncode, WRONG_USAGE, arguments)
        twice = self.edsc("monitor", "--node", "5=device.eds", "--node", "5=device.eds", "--once", "1s")
        self.expect(twice, WRONG_USAGE, stderr="edsc: --node 5=device.eds: node 5 is given twice\n")


if __name__ == "__main__":
    run()
