#!/usr/bin/env python3
"""The masters of examples/networks and the nodes of their plants as programs, in real time.

    live_test.py SOURCE_DIR EDSC MASTERS NODES [--bus BUS] [unittest arguments]      MASTERS, NODES: folders of the programs

Without --bus they are on a bus of `edsc bus`.

A busy machine delays heartbeats, so that more nodes may be lost and booted than expected here, also the one that is killed: the
tests on a virtual bus count them. A master does not boot a node again whose heartbeat came too late in its boot-up: its program is then
started again.
"""

from __future__ import annotations

import json
import queue
import re
import subprocess
import sys
import threading
import time
import unittest
from collections.abc import Callable
from pathlib import Path

SOURCE_DIR, EDSC, MASTERS, NODES = (Path(argument).resolve() for argument in sys.argv[1:5])
BUS = sys.argv[6] if sys.argv[5:6] == ["--bus"] else None
NETWORKS = SOURCE_DIR / "examples/networks"
LATE = 300.0  # maximum seconds until a line on a busy machine


class Lines:
    """The lines that a program prints, as they come."""

    def __init__(self, program: subprocess.Popen[str]) -> None:
        self.queue: queue.Queue[str] = queue.Queue()
        self.seen: list[str] = []
        self.thread = threading.Thread(target=self.read, args=(program,), daemon=True)
        self.thread.start()

    def read(self, program: subprocess.Popen[str]) -> None:
        for line in program.stdout:
            self.queue.put(line.rstrip("\n"))

    def wait_for(self, expected: set[str], use: Callable[[str], None] = lambda line: None) -> None:
        """Reads until a line has matched each of these expressions; they need not be in this order. Calls `use` for each line."""
        missing, end = set(expected), time.monotonic() + LATE
        while missing:
            try:
                self.seen.append(self.queue.get(timeout=max(0.0, end - time.monotonic())))
            except queue.Empty:
                raise AssertionError(f"not printed: {sorted(missing)}\nprinted:\n" + "\n".join(self.seen)) from None
            use(self.seen[-1])
            missing = {line for line in missing if not re.fullmatch(line, self.seen[-1])}

    def wait_until_not_booted(self, node: str) -> None:
        """Reads until the node is lost, or its boot-up has failed. Either may have been read before."""
        not_booted = rf"{node}: lost, last state [a-z-]+|[^ ]+:\d+: {node}: .*"
        of_node = [line for line in self.seen if re.fullmatch(rf"{node}: booted|{not_booted}", line)]
        if not re.fullmatch(not_booted, of_node[-1]):
            self.wait_for({not_booted})


class Masters(unittest.TestCase):
    def start(self, *command: object) -> subprocess.Popen[str]:
        program = subprocess.Popen(list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.addCleanup(self.end, program)
        return program

    @staticmethod
    def end(program: subprocess.Popen[str]) -> None:
        program.kill()
        program.communicate()

    def start_node(self, name: str) -> subprocess.Popen[str]:
        node = self.nodes[name]
        program = Path(node["eds"]).stem.replace("-", "_")
        process = self.start(NODES / program, self.address, "--node-id", node["node_id"])
        Lines(process)  # what it prints must not fill the pipe
        return process

    def check_plant(self, plant: str, lost: str) -> None:
        self.nodes = json.loads(re.sub(r"^\s*//.*$", "", (NETWORKS / f"{plant}.json").read_text(), flags=re.MULTILINE))["nodes"]
        slaves = [name for name, node in self.nodes.items() if "eds" in node]
        self.address = BUS or self.start(EDSC, "bus", "--listen", "127.0.0.1:0").stdout.readline().strip()
        running = {name: self.start_node(name) for name in slaves}
        master = self.start(MASTERS / plant, self.address)
        lines = Lines(master)

        def restart_failed(line: str) -> None:
            failed = re.fullmatch(r"[^ ]+:\d+: ([^ :]+): no heartbeat when error control was started", line)
            if failed and failed[1] in running:
                self.end(running[failed[1]])
                running[failed[1]] = self.start_node(failed[1])

        lines.wait_for({f"{name}: booted" for name in slaves}, restart_failed)
        self.end(running[lost])
        lines.wait_until_not_booted(lost)
        self.start_node(lost)
        lines.wait_for({f"{lost}: booted"})
        master.terminate()
        self.assertEqual(master.wait(timeout=LATE), 0)

    def test_four_modules(self) -> None:
        self.check_plant("four_modules", "analog_inputs")

    def test_twelve_axes(self) -> None:
        self.check_plant("twelve_axes", "axis5")

    def test_eight_devices(self) -> None:
        self.check_plant("eight_devices", "sensor")

    def test_failed_boot_ups_have_their_lines(self) -> None:
        """Another module instead of one, and one that is missing: the line of the EDS, and that of the network file."""
        plant = NETWORKS / "four_modules.json"
        self.address = BUS or self.start(EDSC, "bus", "--listen", "127.0.0.1:0").stdout.readline().strip()
        Lines(self.start(NODES / "can_2057c", self.address, "--node-id", 2))
        lines = Lines(self.start(MASTERS / "four_modules", self.address))
        sheet = (NETWORKS / "../../eds/can-2053c.eds").read_text(encoding="latin-1").splitlines()
        section = next(at for at, line in enumerate(sheet) if line.strip() == "[1000]")
        device_type = next(at for at in range(section, len(sheet)) if sheet[at].lower().startswith("defaultvalue="))
        missing = next(at for at, line in enumerate(plant.read_text().splitlines()) if '"analog_outputs": {' in line)
        lines.wait_for({rf"\.\./\.\./eds/can-2053c\.eds:{device_type + 1}: digital_inputs: device type 1000h is not .*",
                        rf"four_modules\.json:{missing + 1}: analog_outputs: no answer, .*"})

    def test_usage(self) -> None:
        result = subprocess.run([MASTERS / "four_modules"], capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertIn("usage: ", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[7 if BUS else 5:]])
