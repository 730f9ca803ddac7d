#!/usr/bin/env python3
"""A master without edsc's code tests the eight reference nodes, which run at the same time on one bus.

    masters_test.py {--nodes DIR | --simulated} [--edsc EDSC | --bus ADDRESS] [--node-canopen WORK_DIR] [--short] [--only NAME]

The nodes are programs in DIR, or `edsc node` runs all of them, which has only their EDS files.
The bus is one of `edsc bus`, or the one at ADDRESS, such as socketcan:vcan0. The master is python-can with walk.py, or
node-canopen, which npm installs in WORK_DIR. --short omits the long lists of SDO transfers. Prints each failure, and a line
for each device. Exit code 77: skipped.
"""

from __future__ import annotations

import argparse
import ctypes
import importlib.util
import signal
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
DATA_SHEETS = HERE.parent.parent / "eds"
EXCEPTIONS = HERE / "exceptions.tsv"
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
from npm_packages import Skipped, install_npm_packages  # noqa: E402

# Program and node-ID of each node.
NODES = {"can_2017c": 1, "can_2024c": 2, "can_2053c": 3, "can_2057c": 4, "cpc_tc1": 5, "cpd": 6, "ezd_1136": 7, "rk5c": 8}
SKIPPED = 77


def data_sheet_of(node: str) -> Path:
    return DATA_SHEETS / f"{node.replace('_', '-')}.eds"


def end_with_parent() -> None:
    """Runs in the child before its program: a node ends if the test is killed."""
    set_parent_death_signal = 1  # PR_SET_PDEATHSIG of prctl(2)
    ctypes.CDLL(None).prctl(set_parent_death_signal, signal.SIGKILL)


class Plant:
    """A bus and the nodes on it."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.programs: list[subprocess.Popen[str]] = []
        self.nodes: dict[str, subprocess.Popen[str]] = {}
        self.names = [name for name in NODES if arguments.only in (None, name)]
        self.directory = arguments.nodes
        self.edsc = arguments.edsc
        self.address = arguments.bus or self.serve(arguments.edsc)

    def __enter__(self) -> Plant:
        return self

    def __exit__(self, *_: object) -> None:
        for program in reversed(self.programs):  # the bus last
            program.kill()
            program.wait()

    def serve(self, edsc: Path) -> str:
        bus = subprocess.Popen([edsc, "bus", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True,
                               preexec_fn=end_with_parent)
        self.programs.append(bus)
        return bus.stdout.readline().strip()

    def power_on(self) -> None:
        if self.directory is None:
            nodes = [word for name in self.names for word in ("--node", f"{NODES[name]}={data_sheet_of(name)}")]
            self.switch_on("edsc node", [self.edsc, "node", self.address, *nodes, "--quiet"])
            return
        for name in self.names:
            self.switch_on(name, [self.directory / name, self.address, "--node-id", str(NODES[name])])

    def switch_on(self, name: str, words: list[object]) -> None:
        node = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, preexec_fn=end_with_parent)
        self.programs.append(node)
        self.nodes[name] = node

    def power_off(self) -> int:
        """Returns the number of nodes that ended with an error."""
        failed = 0
        for name, node in self.nodes.items():
            node.terminate()
            if (code := node.wait(timeout=600)) != 0:
                print(f"{name}: ended with {code} after SIGTERM")
                failed += 1
        return failed

    def tell(self, name: str, line: str) -> None:
        """Writes an input line to the standard input of a node."""
        self.nodes[name].stdin.write(line + "\n")
        self.nodes[name].stdin.flush()


def with_python_can(plant: Plant, short: bool) -> int:
    """Returns the number of failures plus that of exceptions that no device needs any more."""
    if importlib.util.find_spec("can") is None:
        raise Skipped("python3-can is not installed")
    from data_sheet import DataSheet
    from report import Report, read_exceptions, stale
    from walk import Walk
    from wire import Wire

    exceptions = read_exceptions(EXCEPTIONS)
    wire = Wire(plant.address)
    failed = 0
    plant.power_on()
    reports = {name: Report(name, exceptions) for name in plant.names}
    for name in plant.names:
        reports[name].check("boot-up", "power-on", str(wire.receive(0x700 + NODES[name], 10)), str(b"\0"))
    for name in plant.names:
        begin = time.monotonic()
        Walk(wire, DataSheet(data_sheet_of(name), NODES[name]), reports[name],
             lambda line, name=name: plant.tell(name, line), short).run()
        print(f"{reports[name].summary()} ({time.monotonic() - begin:.1f} s)", flush=True)
        failed += sum(reports[name].failed.values())
    wire.close()
    unneeded = stale(exceptions) if len(plant.names) == len(NODES) and not short else []
    print("\n".join(unneeded), end="\n" if unneeded else "")
    return failed + len(unneeded)


def install_node_canopen(work: Path) -> Path:
    """Returns its program, after installing the packages of the lock file in the same folder."""
    install_npm_packages(HERE / "node_canopen", work)
    return work / "master.js"


def with_node_canopen(plant: Plant, work: Path) -> int:
    """Returns the exit code of its program."""
    master = install_node_canopen(work)
    plant.power_on()
    nodes = [f"{name}={NODES[name]}" for name in plant.names]
    return subprocess.run(["node", master, plant.address, DATA_SHEETS, EXCEPTIONS, *nodes], check=False).returncode


def main() -> int:
    parser = argparse.ArgumentParser()
    nodes = parser.add_mutually_exclusive_group(required=True)
    nodes.add_argument("--nodes", type=Path)
    nodes.add_argument("--simulated", action="store_true")
    parser.add_argument("--edsc", type=Path)
    parser.add_argument("--bus")
    parser.add_argument("--node-canopen", type=Path)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--only", choices=NODES)
    arguments = parser.parse_args()
    begin = time.monotonic()
    try:
        with Plant(arguments) as plant:
            if arguments.node_canopen:
                failures = with_node_canopen(plant, arguments.node_canopen)
            else:
                failures = with_python_can(plant, arguments.short)
            failures += plant.power_off()
    except Skipped as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    print(f"{time.monotonic() - begin:.1f} s")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
