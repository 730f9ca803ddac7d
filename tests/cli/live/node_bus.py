"""The base of the tests of edsc node: python-can, with an SDO client of its own, is the master on a bus of edsc bus.

The arguments of the scripts that use it are SOURCE_DIR EDSC.
"""

from __future__ import annotations

import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/masters"))

from wire import Wire  # noqa: E402

FINE, FAILED, WRONG_USAGE = 0, 1, 2
PATIENCE = 20.0
NMT = 0x000
START, RESET_NODE = 0x01, 0x81


def device(name: str) -> Path:
    return SOURCE_DIR / f"eds/{name}.eds"


class NodeOnBus(unittest.TestCase):
    """Each test has a bus and a folder of its own."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-node-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        bus = self.run_program("bus", "--listen", "127.0.0.1:0")
        self.address = bus.stdout.readline().strip()
        self.wire = Wire(self.address)
        self.addCleanup(self.wire.close)

    def run_program(self, *words: object) -> subprocess.Popen[str]:
        process = subprocess.Popen([EDSC, *map(str, words)], cwd=self.folder, text=True, stdin=subprocess.PIPE,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def node(self, *words: object, ready: int = 1) -> tuple[subprocess.Popen[str], list[str]]:
        """A running `edsc node`, and the lines that it prints when it is ready."""
        process = self.run_program("node", self.address, *words)
        lines = [process.stdout.readline() for _ in range(ready)]
        return process, lines

    def end(self, process: subprocess.Popen[str]) -> None:
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(timeout=60), FINE)

    def refused(self, exit_code: int, *words: object) -> str:
        result = subprocess.run([EDSC, "node", self.address, *map(str, words)], cwd=self.folder, text=True, capture_output=True,
                                timeout=60, check=False)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result.stderr

    def expect_frame(self, can_id: int, data: bytes) -> None:
        """Waits for a frame with this CAN-ID and data."""
        end = time.monotonic() + PATIENCE
        seen = []
        while time.monotonic() < end:
            seen.append(self.wire.receive(can_id, PATIENCE))
            if seen[-1] == data:
                return
        self.fail(f"{can_id:03X} {data.hex(' ')} is missing: {seen[-5:]}")
