#!/usr/bin/env python3
"""edsc watch on logs of the plants of examples/networks: silent in normal operation, and an alarm for each planted fault.

    watch_test.py SOURCE_DIR EDSC LOG_PROGRAMS [--seconds N] [--twelve-axes-seconds N] [unittest arguments]

LOG_PROGRAMS is the folder of the programs that simulate the plants. The runtime's master and nodes write the logs; the expected
alarms are those of the table below, by the meaning of the planted frames in CiA 301 and in the network file.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import jsonschema

SOURCE_DIR, EDSC, PROGRAMS = (Path(argument).resolve() for argument in sys.argv[1:4])
# Ten hours if nothing else is given; the twelve axes send 2,800 frames in a second, and get a twentieth of the time.
parser = argparse.ArgumentParser()
parser.add_argument("--seconds", type=int, default=36_000)
parser.add_argument("--twelve-axes-seconds", type=int)
options, OTHER_ARGUMENTS = parser.parse_known_args(sys.argv[4:])
SECONDS = options.seconds
TWELVE_AXES_SECONDS = options.twelve_axes_seconds or SECONDS // 20
LINE = re.compile(r"\((\d+)\.(\d+)\) can0 ([0-9A-F]+)#([0-9A-FR]*)")
SCHEMA = json.loads((SOURCE_DIR / "docs/schema/watch.schema.json").read_text())
SECOND = 1_000_000
OPERATED = 40  # seconds of normal operation after the boot-up


class Frame(NamedTuple):
    us: int
    id: str
    data: str


Log = list[Frame]


def plant_file(plant: str) -> Path:
    return SOURCE_DIR / f"examples/networks/{plant}.json"


def read_log(plant: str, seconds: int) -> Log:
    text = subprocess.run([PROGRAMS / f"{plant}_log", str(seconds)], check=True, capture_output=True, text=True).stdout
    return [Frame(int(found[1]) * SECOND + int(found[2]), found[3], found[4]) for found in LINE.finditer(text)]


def text_of(log: Log) -> str:
    return "".join(f"({one.us // SECOND}.{one.us % SECOND:06}) can0 {one.id}#{one.data}\n" for one in log)


def insert(*frames: tuple[float, str], at: float = 20) -> Callable[[Log], Log]:
    """Adds frames, each with its seconds after `at` seconds of normal operation."""
    def change(log: Log) -> Log:
        begin = log[-1].us - int((OPERATED - at) * SECOND)
        added = [Frame(begin + int(after * SECOND), *frame.split("#")) for after, frame in frames]
        return sorted([*log, *added], key=lambda one: one.us)
    return change


def repeat(frame: str, every: float, count: int) -> Callable[[Log], Log]:
    return insert(*((i * every, frame) for i in range(count)))


def remove(ids: set[str], seconds: float) -> Callable[[Log], Log]:
    """Without the frames of these CAN-IDs, from 20 s on; an empty set: without all frames."""
    def change(log: Log) -> Log:
        begin = log[-1].us - (OPERATED - 20) * SECOND
        end = begin + int(seconds * SECOND)
        return [one for one in log if not (begin <= one.us < end and (one.id in ids or not ids))]
    return change


def replace(can_id: str, old: str, new: str, count: int = 1) -> Callable[[Log], Log]:
    """Other data in the first frames with this CAN-ID and data that begin with `old`."""
    def change(log: Log) -> Log:
        left, changed = count, []
        for one in log:
            if left > 0 and one.id == can_id and one.data.startswith(old):
                left -= 1
                one = one._replace(data=new + one.data[len(new):] if len(new) < len(one.data) else new)
            changed.append(one)
        assert left == 0, f"{can_id}#{old} is not in the log"
        return changed
    return change


def after_boot_up(can_id: str, seconds: float, frame: str) -> Callable[[Log], Log]:
    """Adds a frame after the last boot-up message of a node."""
    def change(log: Log) -> Log:
        booted = max(one.us for one in log if one.id == can_id and one.data == "00")
        return sorted([*log, Frame(booted + int(seconds * SECOND), *frame.split("#"))], key=lambda one: one.us)
    return change


def state(node: int, code: str, *before: tuple[float, str]) -> Callable[[Log], Log]:
    """A node with this state in its heartbeats, and without PDOs, from 20 s on."""
    def change(log: Log) -> Log:
        begin = log[-1].us - (OPERATED - 20) * SECOND
        changed = []
        for one in log:
            if one.us >= begin and one.id == f"{0x700 + node:03X}":
                one = one._replace(data=code)
            is_pdo = 0x180 <= int(one.id, 16) < 0x580 and int(one.id, 16) & 0x7F == node and int(one.id, 16) & 0x80
            if not (one.us >= begin and is_pdo):
                changed.append(one)
        return insert(*before)(changed)
    return change


def shorten(can_id: str) -> Callable[[Log], Log]:
    def change(log: Log) -> Log:
        begin = log[-1].us - (OPERATED - 20) * SECOND
        at = next(i for i, one in enumerate(log) if one.us >= begin and one.id == can_id)
        return [*log[:at], log[at]._replace(data=log[at].data[:-2]), *log[at + 1:]]
    return change


class Planted(NamedTuple):
    name: str
    change: Callable[[Log], Log]
    alarm: str
    node: str | None = None
    plant: str = "eight_devices"
    text: str = ""


READ_1018 = "608#4018100100000000"
PLANTED = (
    Planted("a CAN-ID of no service", insert((0, "110#01")), "can-id-unknown"),
    Planted("an extended CAN-ID", insert((0, "18FF0123#0102")), "can-id-unknown"),
    Planted("an RPDO of a drive, which no node sends", insert((0, "205#0F00")), "can-id-unknown", text="drive RPDO 1 receives it"),
    Planted("SYNC in a plant without SYNC", insert((0, "080#")), "can-id-unknown"),
    Planted("the heartbeat of another node", insert((0, "714#05")), "node-unknown"),
    Planted("an SDO request to another node", insert((0, "61E#4000100000000000")), "node-unknown"),
    Planted("stop to all nodes", insert((0, "000#0200")), "nmt-command", text="stop: all nodes"),
    Planted("reset to a node that is Operational", insert((0, "000#8108")), "nmt-command", "sensor"),
    Planted("start to a node that is Operational", insert((0, "000#0105")), "nmt-command", "drive"),
    Planted("an unknown NMT command", insert((0, "000#5505")), "nmt-command"),
    Planted("an LSS command", insert((0, "7E5#0401000000000000")), "lss-command"),
    Planted("a write to the controlword", insert((0, "605#2B4060000F000000")), "sdo-write", "drive", text="6040h:00"),
    Planted("a write to 1017h of a node that is Operational", insert((0, "605#2B171000E8030000")), "sdo-write", "drive",
            text="while the node is Operational"),
    Planted("a program download in blocks", insert((0, "607#C6501F0164000000")), "sdo-write", "axis", text="1F50h:01"),
    Planted("another heartbeat time at the boot-up", replace("608", "2B171000F401", "2B171000E803"), "sdo-value", "sensor"),
    Planted("a shorter PDO", shorten("188"), "pdo-length", "sensor"),
    Planted("a second sender of a PDO", repeat("188#000000000000", 0.02, 250), "pdo-rate", "sensor"),
    Planted("a PDO that ends", remove({"188"}, 5), "pdo-missing", "sensor"),
    Planted("a PDO before the node is started", after_boot_up("708", 0.25, "188#000000000000"), "pdo-state", "sensor"),
    Planted("a short EMCY", insert((0, "085#00001000")), "frame-length", "drive"),
    Planted("a heartbeat of two bytes", insert((0, "708#0500")), "frame-length", "sensor"),
    Planted("a request for a PDO", insert((0, "188#R8")), "remote-frame", "sensor"),
    Planted("a node without power", remove({"708", "188", "288", "388", "488", "588", "088"}, 100), "node-missing", "sensor"),
    Planted("a node that restarts", state(8, "7F", (-0.0001, "708#00")), "node-restarted", "sensor"),
    Planted("a node that leaves Operational", state(8, "7F"), "node-state", "sensor"),
    Planted("another vendor-ID", replace("588", "42181001", "4218100199"), "node-replaced", "sensor"),
    Planted("another heartbeat time in a running node", insert((0, "608#4017100000000000"), (0.001, "588#4B171000E8030000")),
            "node-configuration", "sensor"),
    Planted("a second node with the node-ID", repeat("708#05", 0.1, 50), "node-duplicate", "sensor"),
    Planted("a gap of the whole bus", remove(set(), 5), "bus-silent"),
    Planted("a flood of requests", repeat(READ_1018, 0.0009, 3300), "bus-load"),
    Planted("a second SYNC producer", insert((0.0035, "080#")), "sync-rate", "controller", "twelve_axes"),
    Planted("SYNC that ends, and all PDOs with it", remove({"080", *(f"{base + i:03X}" for base in range(0x180, 0x580, 0x80)
                                                                  for i in range(1, 0x80))}, 3), "sync-missing", "controller",
            "twelve_axes"),
)


class Watch(unittest.TestCase):
    maxDiff = None
    logs: dict[str, Log] = {}

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def log_of(self, plant: str) -> Log:
        if plant not in self.logs:
            self.logs[plant] = read_log(plant, OPERATED)
        return self.logs[plant]

    def watch(self, plant: str, log: Log, *arguments: str, exit_code: int = 1) -> list[dict]:
        (self.folder / "bus.log").write_text(text_of(log))
        result = subprocess.run([EDSC, "watch", "bus.log", "--network", plant_file(plant), "--format", "json", *arguments],
                                cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (exit_code, ""), result.stdout)
        alarms = [json.loads(line) for line in result.stdout.splitlines()]
        for alarm in alarms:
            jsonschema.validate(alarm, SCHEMA)
        return alarms

    def test_is_silent_in_normal_operation(self) -> None:
        """The programs also have EMCY messages, reads of a tool, aborted transfers, and PDOs that the recorder has lost."""
        for plant, seconds in (("four_modules", SECONDS), ("eight_devices", SECONDS), ("twelve_axes", TWELVE_AXES_SECONDS)):
            with self.subTest(plant):
                program = subprocess.Popen([PROGRAMS / f"{plant}_log", str(seconds)], stdout=subprocess.PIPE)
                result = subprocess.run([EDSC, "watch", "-", "--network", plant_file(plant)], stdin=program.stdout,
                                        capture_output=True, text=True)
                program.stdout.close()
                self.assertEqual(program.wait(), 0)
                watched = re.fullmatch(r"<stdin>: \d+ frames in ([\d.]+) s: no alarms\n", result.stdout)
                self.assertTrue(watched, result.stdout[-2000:] + result.stderr)
                self.assertGreaterEqual(float(watched[1]), seconds - 2)
                self.assertEqual(result.returncode, 0)

    def test_raises_the_alarm_of_each_planted_fault_and_no_other(self) -> None:
        self.assertGreaterEqual(len(PLANTED), 25)
        for planted in PLANTED:
            with self.subTest(planted.name):
                alarms = self.watch(planted.plant, planted.change(self.log_of(planted.plant)))
                self.assertEqual({(one["alarm"], one["node"]) for one in alarms}, {(planted.alarm, planted.node)}, alarms)
                self.assertIn(planted.text, alarms[0]["text"])

    def test_has_a_fault_for_each_alarm(self) -> None:
        listed = json.loads(subprocess.run([EDSC, "watch", "--list-alarms", "--format", "json"], capture_output=True, text=True,
                                           check=True).stdout)
        jsonschema.validate(listed, SCHEMA)
        self.assertEqual({row["id"] for row in listed["alarms"]}, {planted.alarm for planted in PLANTED})

    def test_counts_what_goes_on(self) -> None:
        """30 stop commands in 3 s are one alarm, and a second one after the time of --remind."""
        flood = repeat("000#0200", 0.1, 30)(self.log_of("eight_devices"))
        self.assertEqual(len(self.watch("eight_devices", flood)), 1)
        alarms = self.watch("eight_devices", flood, "--remind", "2s")
        self.assertEqual([one["suppressed"] for one in alarms], [0, 19])
        self.assertEqual(len(self.watch("eight_devices", flood, "--remind", "0s")), 30)

    def test_a_clock_that_is_set_back(self) -> None:
        """The alarms have the times of their frames in the log, and a message states the line."""
        lss = "7E5#0401000000000000"
        log = insert((0, lss), (10, lss))(self.log_of("eight_devices"))
        first, second = (at for at, one in enumerate(log) if one.id == "7E5")
        step = (first + second) // 2
        log = log[:step] + [one._replace(us=one.us - 7 * SECOND) for one in log[step:]]
        back_us = log[step - 1].us - log[step].us
        (self.folder / "bus.log").write_text(text_of(log))
        result = subprocess.run([EDSC, "watch", "bus.log", "--network", plant_file("eight_devices"), "--format", "json", "--remind", "0s"],
                                cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.stderr,
                         f"bus.log:{step + 1}: the times go back by {back_us / SECOND:.3f} s; the watch continues without a gap\n")
        alarms = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([(one["alarm"], one["time_us"]) for one in alarms], [("lss-command", log[at].us) for at in (first, second)])

    def test_options(self) -> None:
        log = self.log_of("eight_devices")
        write = insert((0, "605#2B4060000F000000"))(log)
        self.assertEqual(self.watch("eight_devices", write, "--allow", "drive.6040h", exit_code=0), [])
        self.assertEqual(self.watch("eight_devices", write, "--silence", "sdo-write", exit_code=0), [])
        both = insert((0, "605#2B4060000F000000"), (1, "7E5#0401000000000000"), (2, "000#0200"))(log)
        for option, expected in (("any", ["sdo-write"]), ("lss-command", ["sdo-write", "lss-command"])):
            alarms = self.watch("eight_devices", both, "--exit-on", option)
            self.assertEqual([one["alarm"] for one in alarms], expected)
        command = 'echo "$EDSC_ALARM|$EDSC_ALARM_NODE|$EDSC_ALARM_NODE_ID|$EDSC_ALARM_SEVERITY" >> alarms.txt'
        self.watch("eight_devices", both, "--run", command)
        self.assertEqual((self.folder / "alarms.txt").read_text(),
                         "sdo-write|drive|5|error\nlss-command|||error\nnmt-command|||error\n")

    def test_rejects_wrong_options(self) -> None:
        for arguments, expected in ((("--allow", "drive"), "is not NODE.OBJECT"), (("--allow", "drve.6040h"), 'did you mean "drive"'),
                                    (("--exit-on", "no-alarm"), "--exit-on"), (("--silence", "no-alarm"), "--list-alarms"),
                                    (("--for", "1s"), "--for requires a bus"), (("--silence", "sdo-write", "--exit-on", "sdo-write"), "because of --silence")):
            result = subprocess.run([EDSC, "watch", "-", "--network", plant_file("eight_devices"), *arguments], input="",
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertIn(expected, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *OTHER_ARGUMENTS])
