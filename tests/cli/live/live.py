"""The base of the tests with nodes on a bus of `edsc bus`: each test has a bus and a folder of its own.

The arguments of the scripts that use it are SOURCE_DIR EDSC LIVE_NODES [unittest arguments].
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import jsonschema
from network import Network

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
LIVE_NODES = Path(sys.argv[3]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/live_device.eds"
FINE, FAILED, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130
PATIENCE_MS = 60_000  # for an answer that must be received, even on a busy machine
ABORT_GENERAL = "605 80 17 10 00 00 00 00 08"


def entry(section: str, name: str, data_type: int, access: str, value: object) -> str:
    return (f"\n[{section}]\nParameterName={name}\nObjectType=7\nDataType={data_type}\nAccessType={access}\n"
            f"DefaultValue={value}\nPDOMapping=0\n")


def every_command() -> set[str]:
    """The commands of edsc, without those that have other commands: `network check`."""
    listed = json.loads(subprocess.run([EDSC, "completion", "json"], capture_output=True, text=True, check=True).stdout)
    names = {command["command"] for command in listed["commands"]}
    return {name for name in names if name and not any(other.startswith(f"{name} ") for other in names)}


class LiveTest(unittest.TestCase):
    maxDiff = None
    nodes: tuple[int, ...] = (5,)

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-live-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(SHEET, self.folder / "device.eds")
        self.network = Network(EDSC, LIVE_NODES, *self.nodes)
        self.addCleanup(self.network.close)

    def command(self, command: str, *arguments: object) -> list[str]:
        if command in ("read", "write", "configure", "save") and "--timeout" not in arguments:
            arguments = (*arguments, "--timeout", f"{PATIENCE_MS}ms")
        return [str(EDSC), command, self.network.address, *map(str, arguments)]

    def edsc(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(command, *arguments), cwd=self.folder, capture_output=True, text=True,
                              timeout=600)

    def start(self, command: str, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(self.command(command, *arguments), cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def expect(self, result: subprocess.CompletedProcess[str], exit_code: int, stdout: str = "", stderr: str = "") -> None:
        self.assertEqual((result.stdout, result.stderr, result.returncode), (stdout, stderr, exit_code))

    def expect_json(self, result: subprocess.CompletedProcess[str], schema: str, exit_code: int = FINE) -> dict:
        self.assertEqual(result.returncode, exit_code, result.stderr)
        found = json.loads(result.stdout)
        jsonschema.validate(found, json.loads((SOURCE_DIR / "docs/schema" / schema).read_text()))
        return found


class ReferenceDevices(LiveTest):
    """A bus with the eight reference devices as node 1 to 8. LIVE_NODES is the program of one of them; those of the others
    are in the same folder."""

    nodes = ()
    devices = ("can-2017c", "can-2024c", "can-2053c", "can-2057c", "cpc-tc1", "cpd", "ezd-1136", "rk5c")
    node_ids = range(1, len(devices) + 1)
    sheets = tuple(f"--node={node_id}={SOURCE_DIR}/eds/{device}.eds" for node_id, device in enumerate(devices, 1))

    def start_devices(self) -> None:
        """Returns after the boot-up message of each."""
        for node_id, device in zip(self.node_ids, self.devices):
            program = LIVE_NODES.parent / device.replace("-", "_")
            process = subprocess.Popen([program, self.network.address, "--node-id", str(node_id)], stdout=subprocess.DEVNULL)
            self.addCleanup(process.wait)
            self.addCleanup(process.kill)
        for node_id in self.node_ids:
            self.wait_for(f"{0x700 + node_id:03X} 00")

    def wait_for(self, frame: str, count: int = 1) -> None:
        while self.network.log.count(frame) < count:
            time.sleep(0.02)


def run() -> None:
    """Runs the tests of the script. Exit code 77: all were skipped."""
    result = unittest.main(argv=[sys.argv[0], *sys.argv[4:]], exit=False).result
    if result.testsRun == len(result.skipped) > 0:
        print("\n".join(reason for _, reason in result.skipped), file=sys.stderr)
        sys.exit(77)
    sys.exit(not result.wasSuccessful())
