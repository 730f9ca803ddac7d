#!/usr/bin/env python3
"""edsc network run simulates the nodes of a plant that are not on the bus. python-can, with an SDO client of its own, and the masters of
examples/networks are the masters; `edsc node` runs the nodes that are present.

    network_run_test.py SOURCE_DIR EDSC MASTERS [unittest arguments]      MASTERS: folder of the programs
"""

from __future__ import annotations

import configparser
import json
import queue
import re
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.request
from pathlib import Path

SOURCE_DIR, EDSC, MASTERS = (Path(argument).resolve() for argument in sys.argv[1:4])
sys.path.insert(0, str(SOURCE_DIR / "tests/masters"))

from sdo import SdoClient  # noqa: E402
from wire import Wire  # noqa: E402

NETWORKS = SOURCE_DIR / "examples/networks"
FINE, FAILED, WRONG_USAGE = 0, 1, 2
LATE = 120.0  # maximum seconds until a line or a frame on a busy machine
ABSENT = "2s"
NMT, START = 0x000, 0x01
OPERATIONAL = 0x05
REAL_SERIAL = 4711

# Two drives and an encoder: 1017h = 200 ms is a value of the network file, not of an EDS.
PLANT = {
    "bit_rate": 125,
    "nodes": {
        "controller": {"node_id": 127, "master": True, "heartbeat_ms": 500},
        "drive": {"node_id": 5, "eds": "cpd.eds", "heartbeat_ms": 200},
        "second_drive": {"node_id": 6, "eds": "cpd.eds", "heartbeat_ms": 200, "serial_number": 99},
        "encoder": {"node_id": 7, "eds": "rk5c.eds", "heartbeat_ms": 200},
    },
    "signals": [{"from": "encoder", "object": f"{index}h:01", "to": "controller", "every_ms": 100} for index in (6020, 6030)],
}
NODES = {name: node for name, node in PLANT["nodes"].items() if "eds" in node}


def default_value(file: Path, section: str) -> int:
    """The number that an EDS states, read without edsc."""
    eds = configparser.ConfigParser(interpolation=None, strict=False)
    eds.read(file, encoding="latin-1")
    return int(eds[section]["DefaultValue"], 0)


class Lines:
    """The lines that a program prints, as they come."""

    def __init__(self, program: subprocess.Popen[str]) -> None:
        self.queue: queue.Queue[str] = queue.Queue()
        self.seen: list[str] = []
        threading.Thread(target=self.read, args=(program,), daemon=True).start()

    def read(self, program: subprocess.Popen[str]) -> None:
        for line in program.stdout:
            self.queue.put(line.rstrip("\n"))
        self.queue.put("(the end)")

    def wait_for(self, *expected: str) -> list[str]:
        """Reads until a line has matched each of these expressions, in any order. Returns the lines that it has read."""
        missing, end, read = set(expected), time.monotonic() + LATE, []
        while missing:
            try:
                read.append(self.queue.get(timeout=max(0.0, end - time.monotonic())))
            except queue.Empty:
                raise AssertionError(f"not printed: {sorted(missing)}\nprinted:\n" + "\n".join(self.seen + read)) from None
            if read[-1] == "(the end)":
                raise AssertionError(f"not printed: {sorted(missing)}\nprinted:\n" + "\n".join(self.seen + read))
            missing = {line for line in missing if not re.fullmatch(line, read[-1])}
        self.seen += read
        return read


class Runs(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-network-run-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        for name in ("cpd", "rk5c"):
            (self.folder / f"{name}.eds").write_bytes((SOURCE_DIR / f"eds/{name}.eds").read_bytes())
        (self.folder / "plant.json").write_text(json.dumps(PLANT))
        self.address = self.start(EDSC, "bus", "--listen", "127.0.0.1:0").stdout.readline().strip()
        self.wire = Wire(self.address)
        self.addCleanup(self.wire.close)

    def start(self, *words: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(list(map(str, words)), cwd=self.folder, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.addCleanup(self.kill, process)
        return process

    @staticmethod
    def kill(process: subprocess.Popen[str]) -> None:
        process.kill()
        process.wait()
        process.stdin.close()
        process.stdout.close()

    def run_plant(self, *words: object, plant: object = "plant.json") -> tuple[subprocess.Popen[str], Lines]:
        process = self.start(EDSC, "network", "run", self.address, plant, "--absent", ABSENT, *words)
        return process, Lines(process)

    def run_node(self, *words: object) -> subprocess.Popen[str]:
        process = self.start(EDSC, "node", self.address, *words)
        Lines(process).wait_for(r"node \d+ .*")
        return process

    def end(self, process: subprocess.Popen[str]) -> None:
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=LATE), FINE)

    def edsc(self, *words: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *map(str, words)], cwd=self.folder, text=True, capture_output=True, timeout=LATE, check=False)

    def line(self, name: str, what: str) -> str:
        return rf'node {name} \({NODES[name]["node_id"]}\) ".+" on {re.escape(self.address)}: {what}'

    def sdo(self, name: str) -> SdoClient:
        node_id = NODES[name]["node_id"]
        self.wire.forget(0x580 + node_id)  # the answer to edsc network run
        return SdoClient(self.wire, node_id, LATE)

    def serial_number(self, name: str) -> int:
        return struct.unpack("<I", self.sdo(name).upload(0x1018, 4))[0]

    def expect_frame(self, can_id: int, data: bytes) -> None:
        end = time.monotonic() + LATE
        while time.monotonic() < end:
            if self.wire.receive(can_id, LATE) == data:
                return
        self.fail(f"{can_id:03X} {data.hex(' ')} is missing")


class NetworkRun(Runs):
    def test_a_foreign_master_boots_a_plant_of_simulated_nodes(self) -> None:
        process, lines = self.run_plant()
        lines.wait_for(*(self.line(name, "simulated") for name in NODES))
        for name, node in NODES.items():
            self.expect_frame(0x700 + node["node_id"], b"\0")
            file, sdo = self.folder / node["eds"], self.sdo(name)
            self.assertEqual(sdo.upload(0x1018, 2), struct.pack("<I", default_value(file, "1018sub2")))
            self.assertEqual(sdo.upload(0x1017, 0), struct.pack("<H", 200))
        self.assertEqual(self.serial_number("second_drive"), 99)
        self.wire.send(NMT, bytes([START, 0]))
        for node in NODES.values():
            self.expect_frame(0x700 + node["node_id"], bytes([OPERATIONAL]))
        verified = self.edsc("network", "verify", self.address, "plant.json", "--timeout", "60s")
        self.assertEqual(verified.returncode, FINE, verified.stdout + verified.stderr)
        self.end(process)

    def test_a_present_node_is_not_simulated(self) -> None:
        self.run_node("cpd.eds", "--node-id", 5, "--set", f"1018h:04={REAL_SERIAL}", "--set", "1017h=200")
        _, lines = self.run_plant()
        lines.wait_for(self.line("drive", "present; not simulated"),
                       *(self.line(name, "simulated") for name in ("second_drive", "encoder")))
        self.assertEqual(self.serial_number("drive"), REAL_SERIAL)
        self.assertIsNone(self.wire.receive(0x585, 2.0), "a second response")
        self.assertEqual(self.serial_number("second_drive"), 99)

    def test_a_real_node_takes_over_and_leaves(self) -> None:
        """The second node with the name of a simulated one; three times, as a device with a loose contact."""
        _, lines = self.run_plant()
        lines.wait_for(*(self.line(name, "simulated") for name in NODES))
        for _ in range(3):
            real = self.run_node("cpd.eds", "--node-id", 6, "--set", f"1018h:04={REAL_SERIAL}", "--set", "1017h=200")
            read = lines.wait_for(self.line("second_drive", "the device appeared; not simulated"))
            self.assertEqual(len(read), 1, read)
            self.assertEqual(self.serial_number("second_drive"), REAL_SERIAL)
            self.assertIsNone(self.wire.receive(0x586, 2.0), "a second response")
            self.kill(real)
            lines.wait_for(self.line("second_drive", "the device left; simulated"))
            self.assertEqual(self.serial_number("second_drive"), 99)

    def test_scripts_and_device_profiles(self) -> None:
        """A script beside an EDS is for its nodes; the encoder moves, and the drives leave Not Ready To Switch On."""
        (self.folder / "cpd.behaviour.json").write_text(json.dumps({"set": {"6081h": 777}}))
        _, lines = self.run_plant("--scripts", "--device-profile")
        lines.wait_for(*(self.line(name, "simulated") for name in NODES))
        for name in ("drive", "second_drive"):
            drive = self.sdo(name)
            self.assertEqual(drive.upload(0x6081, 0), struct.pack("<I", 777))
            self.assertEqual(struct.unpack("<H", drive.upload(0x6041, 0))[0] & 0x4F, 0x40)
        encoder, seen, end = self.sdo("encoder"), set(), time.monotonic() + LATE
        while len(seen) < 3 and time.monotonic() < end:
            seen.add(encoder.upload(0x6020, 1))
            time.sleep(0.05)
        self.assertEqual(len(seen), 3)

    def test_a_script_with_an_error(self) -> None:
        (self.folder / "rk5c.behaviour.json").write_text('{"set": {"7777h": 1}}')
        run = self.edsc("network", "run", self.address, "plant.json", "--scripts")
        self.assertEqual(run.returncode, FAILED)
        self.assertIn("rk5c.behaviour.json:1:", run.stderr)

    def test_a_quiet_node_remains_present(self) -> None:
        """It has no heartbeat and sends nothing by itself: it is asked, also while another client asks it."""
        self.run_node("cpd.eds", "--node-id", 5, "--set", "1017h=0")
        _, lines = self.run_plant()
        lines.wait_for(self.line("drive", "present; not simulated"))
        end, sdo = time.monotonic() + 10, self.sdo("drive")
        while time.monotonic() < end:
            self.assertEqual(len(sdo.upload(0x1018, 2)), 4)
            time.sleep(0.5)
        time.sleep(10)
        while not lines.queue.empty():
            self.assertNotIn("node drive ", lines.queue.get())

    def test_chosen_nodes(self) -> None:
        master = {
            **PLANT, "signals": [],
            "nodes": {**NODES, "encoder": {**NODES["encoder"], "set": {"1800h:05": 100}},
                      "controller": {"node_id": 10, "master": True, "eds": "cpd.eds"}}}
        (self.folder / "with_master.json").write_text(json.dumps(master))
        for words, expected in ((("--only", "drive,7"), {"drive", "encoder"}), ((), set(NODES)), (("--only", "controller"), {"controller"}),
                                (("--except", "drive", "--except", "encoder"), {"second_drive"})):
            with self.subTest(words):
                process, lines = self.run_plant(*words, plant="with_master.json")
                read = lines.wait_for(*(rf"node {name} \(\d+\) .*: simulated" for name in expected))
                time.sleep(1)
                while not lines.queue.empty():
                    read.append(lines.queue.get())
                self.assertEqual({line.split()[1] for line in read}, expected)
                self.end(process)

    def test_the_log_has_the_frames_of_all_nodes(self) -> None:
        process, lines = self.run_plant("--log", "plant.log", "--quiet")
        for node in NODES.values():
            self.expect_frame(0x700 + node["node_id"], b"\0")
        self.assertEqual(self.sdo("drive").upload(0x1017, 0), struct.pack("<H", 200))
        self.end(process)
        self.assertEqual(lines.queue.get(timeout=LATE), "(the end)", "--quiet")
        log = (self.folder / "plant.log").read_text()
        for frame in ("705#00", "706#00", "707#00", "605#4017100000000000", "585#4B171000C8000000"):
            self.assertRegex(log, rf"(?m)^\(\d+\.\d{{6}}\) vcan0 {frame}$")

    def test_the_page_marks_simulated_nodes(self) -> None:
        self.run_node("cpd.eds", "--node-id", 5)
        process = self.start(EDSC, "network", "run", self.address, "plant.json", "--absent", ABSENT, "--web", "127.0.0.1:0")
        url = process.stdout.readline().strip()
        lines = Lines(process)
        lines.wait_for(*(self.line(name, ".*") for name in NODES))
        with urllib.request.urlopen(url.replace("/?", "/events?"), timeout=LATE) as stream:
            rows: dict[int, dict] = {}
            while set(rows) < {5, 6, 7} or not rows[7]["simulated"]:
                line = stream.readline().decode()
                if line.startswith("data:"):
                    rows |= {row["node_id"]: row for row in json.loads(line[5:])["rows"] if row["kind"] == "node"}
        self.assertEqual({node_id: (rows[node_id]["name"], rows[node_id]["simulated"]) for node_id in (5, 6, 7)},
                         {5: ("drive", False), 6: ("second_drive", True), 7: ("encoder", True)})

    def test_wrong_usage(self) -> None:
        (self.folder / "broken.json").write_text(json.dumps({"nodes": {"drive": {"node_id": 5, "eds": "no_such.eds"}}}))
        for exit_code, message, words in (
                (WRONG_USAGE, 'unknown node "axis"', ("plant.json", "--only", "axis")),
                (WRONG_USAGE, 'unknown node "drvie"; did you mean "drive"?', ("plant.json", "--except", "encoder,drvie")),
                (WRONG_USAGE, "controller", ("plant.json", "--only", "controller")),
                (WRONG_USAGE, "no node", ("plant.json", "--except", "5,6,7")),
                (WRONG_USAGE, "--except", ("plant.json", "--only", "5", "--except", "6")),
                (WRONG_USAGE, "no_such.eds", ("broken.json",)),
                (WRONG_USAGE, "no_such/plant.log", ("plant.json", "--log", "no_such/plant.log"))):
            with self.subTest(words):
                result = self.edsc("network", "run", self.address, *words)
                self.assertEqual(result.returncode, exit_code, result.stderr)
                self.assertIn(message, result.stderr)


class Plants(Runs):
    """The plants of examples/networks with their own masters: `edsc node` runs every second node, the others are simulated."""

    def check_plant(self, plant: str) -> None:
        file = NETWORKS / f"{plant}.json"
        nodes = json.loads(re.sub(r"^\s*//.*$", "", file.read_text(), flags=re.MULTILINE))["nodes"]
        slaves = [name for name, node in nodes.items() if "eds" in node]
        real = slaves[::2]

        def arguments(names: list[str]) -> list[str]:
            return [f"--node={nodes[name]['node_id']}={NETWORKS / nodes[name]['eds']}" for name in names]

        self.run_node(*arguments(real[:-1]))
        leaving = self.run_node(*arguments(real[-1:]))
        _, lines = self.run_plant(plant=file)
        lines.wait_for(*(rf"node {name} .*: {'present; not ' if name in real else ''}simulated" for name in slaves))
        master = self.start(MASTERS / plant, self.address)
        events = Lines(master)
        events.wait_for(*(f"{name}: booted" for name in slaves))
        self.kill(leaving)
        lines.wait_for(rf"node {real[-1]} .*: the device left; simulated")
        events.wait_for(f"{real[-1]}: booted")
        self.run_node(*arguments(real[-1:]))
        lines.wait_for(rf"node {real[-1]} .*: the device appeared; not simulated")
        events.wait_for(f"{real[-1]}: booted")
        master.terminate()
        self.assertEqual(master.wait(timeout=LATE), FINE)

    def test_four_modules(self) -> None:
        self.check_plant("four_modules")

    def test_eight_devices(self) -> None:
        self.check_plant("eight_devices")

    def test_twelve_axes(self) -> None:
        self.check_plant("twelve_axes")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
