#!/usr/bin/env python3
"""edsc discover: logs of python-can whose contents are known, and a bus of `edsc bus`, on which nothing is sent.

    discover_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import random
import re
import struct
import subprocess
import time

import can
import jsonschema
from live import EDSC, FAILED, FINE, SOURCE_DIR, WRONG_USAGE, LiveTest, run

START_TIME = 1_700_000_000.0
SECONDS = 2.0
OPERATIONAL = 0x05
# The identity in tests/fixtures/live_device.eds, and what a client reads.
IDENTITY = {"device_type": (0x1000, 0, 0x00020192), "vendor_id": (0x1018, 1, 0x00ABCDEF), "product_code": (0x1018, 2, 0x1001),
            "revision_number": (0x1018, 3, 0x00010002), "serial_number": (0x1018, 4, 77)}

Frames = list[tuple[float, int, bytes]]


def every(period: float, can_id: int, data: bytes, delay: float = 0.0, jitter: float = 0.0) -> Frames:
    chance = random.Random(can_id)
    return [(place * period + delay + chance.uniform(-jitter, jitter), can_id, data) for place in range(1, int(SECONDS / period))]


def read(at: float, node_id: int, index: int, sub_index: int, value: int) -> Frames:
    return [(at, 0x600 + node_id, struct.pack("<BHBI", 0x40, index, sub_index, 0)),
            (at + 0.001, 0x580 + node_id, struct.pack("<BHBI", 0x43, index, sub_index, value))]


def written(at: float, node_id: int, index: int, sub_index: int, value: int) -> Frames:
    return [(at, 0x600 + node_id, struct.pack("<BHBI", 0x23, index, sub_index, value)),
            (at + 0.001, 0x580 + node_id, struct.pack("<BHBI", 0x60, index, sub_index, 0))]


def plant() -> Frames:
    """Node 5 with heartbeat, TPDO 1 at each SYNC, TPDO 2 at each second one and TPDO 3 with another COB-ID; node 9 with an EMCY;
    a sender that nobody knows."""
    frames = [(0.0, 0x705, b"\0"), (0.4, 0x089, bytes.fromhex("3043090000000000"))]
    for place, (index, sub_index, value) in enumerate(IDENTITY.values()):
        frames += read(0.01 + place / 100, 5, index, sub_index, value)
    frames += written(0.07, 5, 0x1802, 1, 0x3A1)
    frames += every(0.1, 0x705, bytes([OPERATIONAL]), jitter=0.002)
    frames += every(0.01, 0x080, b"")
    frames += every(0.01, 0x185, bytes(4), delay=0.0006, jitter=0.0002)
    frames += every(0.02, 0x285, bytes(8), delay=0.0009, jitter=0.0002)
    frames += every(0.047, 0x3A1, bytes(2), jitter=0.0005)
    frames += [(at, 0x205, bytes(2)) for at in (0.11, 0.12, 0.3, 0.75, 0.8, 1.7)]
    frames += [(0.5, 0x1A7, b"\1"), (0.6, 0x1A7, b"\1\2")]
    return sorted(frames)


class Discover(LiveTest):
    nodes = ()

    def log_of(self, frames: Frames, writer: type = can.CanutilsLogWriter, name: str = "plant.log") -> str:
        log = writer(str(self.folder / name))
        for at, can_id, data in frames:
            log.on_message_received(can.Message(timestamp=START_TIME + at, arbitration_id=can_id, data=data, is_extended_id=False,
                                                channel="can0" if writer is can.CanutilsLogWriter else 1))
        log.stop()
        return name

    def discover(self, *arguments: object, exit_code: int = FINE) -> subprocess.CompletedProcess[str]:
        result = subprocess.run([EDSC, "discover", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result

    def found(self, *arguments: object) -> dict:
        found = json.loads(self.discover(*arguments, "--format", "json").stdout)
        jsonschema.validate(found, json.loads((SOURCE_DIR / "docs/schema/discover.schema.json").read_text()))
        return found

    def expect_plant(self, found: dict) -> None:
        self.assertEqual([node["node_id"] for node in found["nodes"]], [5, 9])
        drive, other = found["nodes"]
        self.assertEqual({name: drive[name] for name in IDENTITY}, {name: row[2] for name, row in IDENTITY.items()})
        self.assertEqual((drive["heartbeat_period_us"], drive["boot_ups"], drive["state"]), (100_000, 1, "operational"))
        self.assertEqual((other["emergencies"], other["heartbeat_period_us"], other["state"]), (1, None, None))
        self.assertEqual(found["sync"], {"period_us": 10_000, "has_counter": False})
        guesses = {pdo["can_id"]: (pdo["transmission"], pdo["every_sync"], pdo["period_us"], pdo["node_id"], pdo["direction"],
                                   pdo["number"], pdo["known_by"]) for pdo in found["pdos"]}
        self.assertEqual(guesses, {
            0x185: ("sync", 1, None, 5, "transmit", 1, "default_cob_id"),
            0x285: ("sync", 2, None, 5, "transmit", 2, "default_cob_id"),
            0x3A1: ("timed", None, 47_000, 5, "transmit", 3, "parameters"),
            0x205: ("event", None, None, 5, "receive", 1, "default_cob_id"),
            0x1A7: ("unknown", None, None, None, None, None, None),
        })
        sizes = {pdo["can_id"]: (pdo["min_bytes"], pdo["max_bytes"]) for pdo in found["pdos"]}
        self.assertEqual(sizes, {0x185: (4, 4), 0x285: (8, 8), 0x3A1: (2, 2), 0x205: (2, 2), 0x1A7: (1, 2)})

    def test_a_plant(self) -> None:
        frames = plant()
        found = self.found(self.log_of(frames))
        self.expect_plant(found)
        self.assertEqual(found["frames"], len(frames))

    def test_another_format(self) -> None:
        self.expect_plant(self.found(self.log_of(plant(), can.ASCWriter, "plant.asc")))

    def test_text(self) -> None:
        text = self.discover(self.log_of(plant())).stdout
        self.assertRegex(text, r"(?m)^plant\.log: \d+ frames in \d\.\d{3} s, 2 nodes$")
        self.assertRegex(text, r"(?mi)^  node 5: operational, heartbeat every 100 ms, 1 boot-up; device type 00020192h, vendor-ID 00ABCDEFh")
        self.assertIn("  SYNC: every 10 ms\n", text)
        self.assertRegex(text, r"(?m)^  CAN-ID 285h: \d+ frames of 8 bytes, every 2 SYNCs; TPDO 2 of node 5, by the pre-defined connection set$")
        self.assertRegex(text, r"(?m)^  CAN-ID 1A7h: 2 frames of 1 to 2 bytes, too few frames; sender unknown$")

    def test_a_timed_pdo_with_the_period_of_sync_is_not_synchronous(self) -> None:
        """Its clock is another one: the delay after SYNC changes."""
        frames = sorted(every(0.01, 0x080, b"") + every(0.01 * 1.004, 0x185, bytes(2), delay=0.001) + [(0.0, 0x705, b"\0")])
        guess = self.found(self.log_of(frames))["pdos"][0]
        self.assertEqual((guess["transmission"], guess["period_us"]), ("timed", 10_000))

    def test_times_that_go_back(self) -> None:
        frames = sorted(every(0.1, 0x705, b"\5") + every(0.1, 0x185, bytes(2), delay=0.01))[:10]
        again = [(at + 0.3, can_id, data) for at, can_id, data in frames]  # begins before the end of the first part
        result = self.discover(self.log_of(frames + again), "--format", "json")
        self.assertEqual(result.stderr, f"edsc: plant.log:11: the time goes back by {frames[-1][0] - again[0][0]:.6f} s; "
                                        "no period is measured across this\n")
        found = json.loads(result.stdout)
        self.assertEqual(found["nodes"][0]["heartbeat_period_us"], 100_000)
        self.assertEqual([(pdo["transmission"], pdo["period_us"]) for pdo in found["pdos"]], [("timed", 100_000)])

    def test_a_network_file(self) -> None:
        result = self.discover(self.log_of(plant()), "--eds", "device.eds", "--bit-rate", 500, "-o", "plant.json",
                               exit_code=FAILED)  # no file fits node 9
        self.assertIn("2 nodes", result.stdout)
        text = (self.folder / "plant.json").read_text()
        network = json.loads(re.sub(r"(?m)^\s*//.*$", "", text))
        jsonschema.validate(network, json.loads((SOURCE_DIR / "docs/schema/network.schema.json").read_text()))
        self.assertEqual(network["bit_rate"], 500)
        self.assertEqual(network["nodes"], {"device_5": {"node_id": 5, "eds": "device.eds", "heartbeat_ms": 100, "serial_number": 77}})
        self.assertIn("// node 5: heartbeat_ms is the measured period\n", text)
        self.assertIn("node 9", text)
        self.assertIn("185h, at each SYNC, TPDO 1 of node 5", network["guessed"]["pdos"][0]["text"])
        made = subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "out"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(made.returncode, FINE, made.stderr)
        self.assertIn("ParameterValue=100", (self.folder / "out/device_5.dcf").read_text())

    def test_a_network_file_without_eds(self) -> None:
        """Its nodes are comments: the reader states the files."""
        result = self.discover(self.log_of(plant()), "-o", "plant.json", exit_code=FAILED)
        self.assertIn("node 5: no file fits", result.stderr)
        text = (self.folder / "plant.json").read_text()
        self.assertIn('// "node_5": {"node_id": 5, "eds": ""}', text)
        self.assertEqual(json.loads(re.sub(r"(?m)^\s*//.*$", "", text))["nodes"], {})

    def test_a_network_file_with_all_nodes(self) -> None:
        self.discover(self.log_of([frame for frame in plant() if frame[1] & 0x7F != 9]), "--eds", "device.eds", "-o", "plant.json")

    def test_a_network_file_without_nodes(self) -> None:
        result = self.discover(self.log_of(every(0.01, 0x080, b"")), "-o", "plant.json", exit_code=FAILED)
        self.assertEqual(result.stderr, "edsc: plant.json: no node was found\n")

    def test_a_bus(self) -> None:
        client = self.network.client()
        process = subprocess.Popen([EDSC, "discover", self.network.address, "--for", "2s", "--format", "json"], cwd=self.folder,
                                   stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        sent = 0
        while process.poll() is None:
            client.send("705 05")
            sent += 1
            time.sleep(0.02)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, FINE)
        self.assertEqual([node["node_id"] for node in json.loads(output)["nodes"]], [5])
        self.assertEqual(len(self.network.frames()), sent)  # those of the client only

    def test_errors(self) -> None:
        self.discover("no_such.log", exit_code=WRONG_USAGE)
        (self.folder / "empty.log").write_text("")
        self.assertIn("no frames", self.discover("empty.log", exit_code=FAILED).stderr)
        self.assertIn("no frame was received", self.discover(self.network.address, "--for", "50ms", exit_code=FAILED).stderr)


if __name__ == "__main__":
    run()
