"""Logs of the plant with changes, and what edsc audit reports about them.

A test that imports this has the arguments SOURCE_DIR EDSC.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import jsonschema
from plant import Frame, Parameters, axis, clean, eds_of, in_order, log_of, sdo, supply

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
SCHEMA = json.loads((SOURCE_DIR / "docs/schema/audit.schema.json").read_text())

Change = Callable[[list[Frame]], list[Frame]]


@dataclass(frozen=True)
class Broken:
    change: Change = lambda frames: frames
    axis: Parameters | None = None
    supply: Parameters | None = None
    arguments: tuple[str, ...] = ()
    line: str = ""  # of the log, beside the frames
    sort: bool = True  # the frames by their times; else they have the order of the unchanged log
    node_id: int | None = None  # of the finding


def add(*frames: Frame) -> Change:
    return lambda log: [*log, *frames]


def data(text: str) -> bytes:
    return bytes.fromhex(text)


def lss(ms: float, request: str, response: str) -> list[Frame]:
    frames = [Frame(ms, 0x7E5, data(request.ljust(16, "0")))]
    return [*frames, Frame(ms + 1, 0x7E4, data(response.ljust(16, "0")))] if response else frames


def replaced(old: list[Frame], position: int, content: str) -> Change:
    """Another content of one of these frames."""
    return lambda log: [Frame(one.ms, one.can_id, data(content)) if one == old[position] else one for one in log]


def guarded(log: list[Frame], responses: tuple[int | None, ...]) -> list[Frame]:
    """Node 5 is guarded every 200 ms from 1150 ms on, without heartbeats."""
    log = [one for one in log if one.can_id != 0x705 or one.ms < 1120]
    log += sdo(1125, 5, "2B17100000000000", "6017100000000000")
    for at, response in enumerate(responses):
        log.append(Frame(1150 + 200 * at, 0x705, remote=True))
        if response is not None:
            log.append(Frame(1151 + 200 * at, 0x705, bytes([response])))
    return log


class Audits(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_edsc(self, *arguments: str, log: str | None = None) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, "audit", *arguments], input=log, cwd=self.folder, capture_output=True, text=True,
                              timeout=600, check=False)

    def audit(self, case: Broken, *arguments: str) -> subprocess.CompletedProcess[str]:
        (self.folder / "axis.eds").write_text(eds_of(case.axis or axis()))
        (self.folder / "supply.eds").write_text(eds_of(case.supply or supply()))
        frames = case.change(clean() if case.sort else in_order(clean()))
        (self.folder / "can0.log").write_text(log_of(in_order(frames) if case.sort else frames) + case.line)
        return self.run_edsc("can0.log", "--node", "5=axis.eds", "--node", "6=supply.eds", *case.arguments, *arguments)

    def report(self, case: Broken, *arguments: str) -> dict:
        result = self.audit(case, "--format", "json", *arguments)
        self.assertEqual(result.stderr, "")
        report = json.loads(result.stdout)
        jsonschema.Draft202012Validator(SCHEMA).validate(report)
        return report
