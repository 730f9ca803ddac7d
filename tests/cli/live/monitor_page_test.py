#!/usr/bin/env python3
"""The page of edsc monitor --web in Chromium, with the eight reference devices on the bus of `edsc bus`.

    monitor_page_test.py SOURCE_DIR EDSC CPD WORK_DIR [--seconds N] [--screenshots FOLDER] [unittest arguments]

CPD is the program of one of the devices; those of the others are in the same folder. npm installs puppeteer-core and
axe-core in WORK_DIR. --seconds: stays open, and prints the memory of the page and of edsc. Exit code 77: skipped.
"""

from __future__ import annotations

import csv
import io
import json
import re
import select
import subprocess
import sys
import threading
import time
from pathlib import Path

WORK = Path(sys.argv.pop(4)).resolve()


def option(name: str, default: str) -> str:
    if name not in sys.argv:
        return default
    at = sys.argv.index(name)
    value = sys.argv[at + 1]
    del sys.argv[at:at + 2]
    return value


SECONDS, SCREENSHOTS = option("--seconds", "0"), option("--screenshots", "")
FRAMES_PER_SECOND = 1000

from live import SOURCE_DIR, ReferenceDevices, run  # noqa: E402

sys.path.append(str(SOURCE_DIR / "tests/support"))
sys.path.append(str(SOURCE_DIR / "tests/masters"))
from browser import CHROMIUM, install_browser  # noqa: E402


class Traffic(threading.Thread):
    """1,000 frames a second: RPDO 1 of each node, with a number that counts."""

    def __init__(self, test: MonitorPage) -> None:
        super().__init__(daemon=True)
        self.client, self.nodes = test.network.client(), len(test.devices)
        self.is_on, self.sent = True, 0
        threading.Thread(target=self.read, daemon=True).start()
        self.start()

    def read(self) -> None:
        try:
            while self.client.socket.recv(65536):
                pass
        except OSError:
            pass

    def run(self) -> None:
        begin = time.monotonic()
        while self.is_on:
            while self.sent < FRAMES_PER_SECOND * (time.monotonic() - begin):
                node_id = 1 + self.sent % self.nodes
                number = (self.sent // self.nodes) & 0xFFFF
                self.client.send(f"{0x200 + node_id:03X} {number & 0xFF:02X} {number >> 8:02X} 00 00 00 00 00 00")
                self.sent += 1
            time.sleep(0.005)


class MonitorPage(ReferenceDevices):
    def memory_kb(self) -> int:
        return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{self.monitor.pid}/status").read_text())[1])

    def start_monitor(self, *arguments: object) -> str:
        """Returns the URL."""
        self.monitor = self.start("monitor", *arguments, "--web", "127.0.0.1:0")
        url = self.monitor.stdout.readline().strip()
        if select.select([self.monitor.stderr], [], [], 0)[0]:
            self.skipTest(self.monitor.stderr.readline().strip())  # built without plots
        return url

    def browse(self, script: str, *arguments: str) -> dict:
        browser = subprocess.run(["node", script, CHROMIUM, *arguments], cwd=WORK, capture_output=True, text=True, check=False)
        self.assertEqual(browser.returncode, 0, browser.stderr)
        return json.loads(browser.stdout)

    def test_what_a_user_does(self) -> None:
        install_browser(SOURCE_DIR, WORK)
        self.start_devices()
        for node_id in self.node_ids:
            self.assertEqual(self.edsc("write", node_id, "1017h", 500, "--type", "u16").returncode, 0)
        self.assertEqual(self.edsc("nmt", "start", "all").returncode, 0)
        url = self.start_monitor(*self.sheets, "--bit-rate", 1000)
        traffic = Traffic(self)
        self.network.client().send("085 30 81 11 00 00 00 00 00")
        before = self.memory_kb()
        found = self.browse("monitor.mjs", url, SECONDS, *([SCREENSHOTS] if SCREENSHOTS else []))
        traffic.is_on = False
        if SECONDS != "0":
            print(f"edsc: {before} kB, then {self.memory_kb()} kB; page: {found['memory']} bytes; {found['last']}")
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        self.assertEqual(found["violations"], {"light": [], "dark": []})
        self.assertEqual(found["connection"], "connected")
        self.assertEqual([int(node[0]) for node in found["nodes"]], list(self.node_ids))
        self.assertEqual({node[2].rstrip("?") for node in found["nodes"]}, {"operational"})
        self.assertEqual(len(found["plots"]), 2)
        self.assertEqual(found["left"], found["plots"][1:])
        self.assertGreater(found["drawn"], 0.01)
        self.assertEqual(found["paused"][0], found["paused"][1])
        self.assertEqual(found["isPressed"], "true")
        self.assertNotEqual(found["resumed"]["summary"], found["paused"][1]["summary"])
        self.assertNotEqual(found["resumed"]["values"], found["paused"][1]["values"])
        self.assertEqual(found["filtered"], 0)
        self.assertIn("8130h", "".join(found["emcys"]))
        self.check_csv(found["csv"])

    def check_csv(self, text: str) -> None:
        self.assertTrue(text.endswith("\r\n"))
        self.assertNotRegex(text.replace("\r\n", ""), r"[\r\n]")
        rows = list(csv.DictReader(io.StringIO(text, newline=""), strict=True))
        self.assertGreater(len(rows), 10)
        self.assertEqual(list(rows[0]), ["time", "node", "pdo", "object", "name", "value", "unit"])
        objects = {(row["node"], row["pdo"], row["object"]) for row in rows}
        self.assertEqual(len(objects), 2, "those that are plotted")
        for one in objects:
            times = [float(row["time"]) for row in rows if (row["node"], row["pdo"], row["object"]) == one]
            self.assertEqual(times, sorted(times))
        self.assertGreater(len({float(row["value"]) for row in rows}), 5)

    def test_rows_of_any_kind(self) -> None:
        install_browser(SOURCE_DIR, WORK)
        found = self.browse("monitor_rows.mjs", self.start_monitor())
        self.assertEqual(found["seen"], {"errors": [], "requests": []})

        def record(time: int, object_: str, number: object) -> str:
            return f"{time}.000000,5,TPDO 1,{object_},{number},\r\n"

        head = "time,node,pdo,object,name,value,unit\r\n"
        real, count = "2000h:01,'=real", "2000h:02,count"
        self.assertEqual(found["csv"]["sameFrame"], head + record(1, count, 7))
        self.assertEqual(found["csv"]["afterNan"], head + record(3, real, 1.5) + record(1, count, 7) + record(3, count, 8))
        absent = "not in the last frame"
        self.assertEqual(found["short"], {"texts": ["2.5", absent], "plots": ["node 5 =real2.5", "node 5 count" + absent]})
        self.assertEqual(found["empty"], {"texts": [absent] * 2, "plots": ["node 5 =real" + absent, "node 5 count" + absent]})
        self.assertEqual(found["whole"], {"texts": ["3.5", "9"], "plots": ["node 5 =real3.5", "node 5 count9"]})
        self.assertEqual(found["csv"]["afterShort"],
                         head + record(3, real, 1.5) + record(4, real, 2.5) + record(6, real, 3.5)
                         + record(1, count, 7) + record(3, count, 8) + record(6, count, 9))
        self.assertEqual(found["mappedAnew"], {"texts": ["3.5", str(-2**63)], "plots": ["node 5 =real3.5"]})
        self.assertGreater(found["wide"], 150, "the numbers of the axis are not cut off")
        self.assertGreater(found["drawn"], 0, "a value of one point is drawn")
        for name in ("connected", "again", "reconnected"):
            self.assertEqual(found[name], ["", "connected"], name)
        for name, text in (("silent", "no answer"), ("lost", "not connected")):
            self.assertEqual(found[name][0], "bad")
            self.assertIn(text, found[name][1])
        self.assertEqual(found["isPressed"], "true", "a key that is held down acts once")
        self.assertEqual(found["hidden"], "9.0", "a tab in the background is not drawn")
        self.assertEqual(found["found"], "1 of 2 values")
        self.assertEqual(found["pausedPlots"], ["node 5 =real3.5", "node 5 other1"], "a new plot leaves those that are paused")
        self.assertEqual(found["header"], "static", "it does not cover what has the focus")
        self.assertEqual(found["ink"], "rgb(27, 31, 36)", "paper is not dark")
        self.assertTrue(found["printed"], "a plot is not wider than the paper")


if __name__ == "__main__":
    run()
