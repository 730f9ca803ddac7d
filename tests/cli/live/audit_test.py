#!/usr/bin/env python3
"""edsc audit: the log of the eight reference devices on the bus of `edsc bus` is clean.

    audit_test.py SOURCE_DIR EDSC CPD [unittest arguments]

CPD is the program of one of the devices; those of the others are in the same folder.
"""

from __future__ import annotations

import signal
import subprocess
import time

from live import EDSC, FINE, ReferenceDevices, run

HEARTBEATS = 5
# A busy machine is late, and the nodes have its clock.
TIMES = ("pdo-event-timer", "pdo-inhibit-time", "heartbeat-late", "heartbeat-early", "sdo-timeout")


class Audit(ReferenceDevices):
    def record(self) -> subprocess.Popen[str]:
        process = self.start("record", "-o", "bus.log")
        client, log = self.network.client(), self.folder / "bus.log"
        while not log.exists() or not log.stat().st_size:
            client.send("080")
            time.sleep(0.05)
        return process

    def test_the_reference_devices_are_clean(self) -> None:
        recording = self.record()
        self.start_devices()
        for node_id in self.node_ids:
            self.assertEqual(self.edsc("write", node_id, "1017h", 200, "--type", "u16").returncode, FINE)
            self.assertEqual(self.edsc("read", node_id, "1018h:01").returncode, FINE)
        for command, state in (("start", 5), ("stop", 4)):
            self.assertEqual(self.edsc("nmt", command, "all").returncode, FINE)
            for node_id in self.node_ids:
                self.wait_for(f"{0x700 + node_id:03X} {state:02X}", HEARTBEATS)
        recording.send_signal(signal.SIGINT)
        recording.wait(timeout=600)
        arguments = [*self.sheets, *(f"--silence={rule}" for rule in TIMES)]
        audit = subprocess.run([EDSC, "audit", self.folder / "bus.log", *arguments], capture_output=True, text=True, timeout=600,
                               check=False)
        self.assertRegex(audit.stdout, r"bus\.log: \d+ frames of 8 nodes in [\d.]+ s: no findings\n$", audit.stderr)
        self.assertEqual(audit.returncode, FINE)


if __name__ == "__main__":
    run()
