"""A node on its own bus, and edsc conform for it."""

from __future__ import annotations

import ctypes
import json
import os
import signal
import subprocess
import time
from collections.abc import Iterable
from pathlib import Path

NODE_ID = 5
LIMIT = 1200.0  # seconds, for programs that hang
TRIES = 8  # runs of a case without a result: a computer may be busy


def end_with_parent() -> None:
    """Runs in the child before its program: a program ends if the test is killed."""
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of prctl(2)
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL)


class Bench:
    """`edsc bus`, and a node program that takes the address of the bus as its first argument. Text that is written to the FIFO
    `lines` in the folder is passed to the standard input of the node."""

    def __init__(self, edsc: Path, folder: Path, address: str = "") -> None:
        folder.mkdir(parents=True)
        self.edsc, self.folder = edsc, folder
        self.processes: list[subprocess.Popen] = []
        self.log = folder / "node.log"
        os.mkfifo(folder / "lines")
        self.lines = os.open(folder / "lines", os.O_RDWR)  # so that the FIFO never ends
        self.address = address or self.start_bus()

    def start_bus(self) -> str:
        bus = subprocess.Popen([self.edsc, "bus", "--listen", "127.0.0.1:0"], text=True, stdout=subprocess.PIPE,
                               preexec_fn=end_with_parent)
        self.processes.append(bus)
        return bus.stdout.readline().strip()

    def start_node(self, program: list[object], arguments: list[object], started: str) -> subprocess.Popen:
        """Starts the node and waits until it has printed `started`."""
        with self.log.open("w") as log:
            node = subprocess.Popen([*map(str, program), self.address, *map(str, arguments)], stdin=self.lines, stdout=log,
                                    preexec_fn=end_with_parent)
        self.processes.append(node)
        end = time.monotonic() + LIMIT
        while started not in self.log.read_text(encoding="utf-8"):
            assert node.poll() is None and time.monotonic() < end, f"{program} does not start"
            time.sleep(0.05)
        return node

    def command(self, sheet: Path, report: Path, *options: object, level: str = "all", timeout_ms: int = 2000) -> list[str]:
        return [*map(str, (self.edsc, "conform", self.address, NODE_ID, sheet, "--level", level, "--timeout", f"{timeout_ms}ms", "--json",
                           report, *options))]

    def conform(self, sheet: Path, report: Path, *options: object, level: str = "all", timeout_ms: int = 2000) -> dict:
        command = self.command(sheet, report, "--quiet", *options, level=level, timeout_ms=timeout_ms)
        result = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
        assert report.is_file(), f"edsc conform ends with {result.returncode}: {result.stderr}"
        return json.loads(report.read_text(encoding="utf-8"))

    def close(self) -> None:
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            process.wait(LIMIT)
            if process.stdout:
                process.stdout.close()
        os.close(self.lines)


def patterns(cases: Iterable[str]) -> list[str]:
    return [f"--only={case}" for case in cases]


def is_late(case: dict) -> bool:
    """Whether the case has no result because a computer was too busy."""
    return case["verdict"] == "inconclusive" and case["condition"] == "punctual"


def run_problems(report: dict) -> list[str]:
    """Returns the problems of the whole run."""
    problems = [f"not restored: {text}" for text in report["not_restored"]]
    if report["ended_early"]:
        problems.append(report["ended_early"])
    return problems
