#!/usr/bin/env python3
"""Prints what nodes without a compiler need: the time in which `edsc node` starts one, and the memory and the CPU time of 20 nodes
in one process that only send their heartbeats.

    nodes.py EDSC PROCESS_FLOOR [RUNS]

The nodes are on a bus of `edsc bus`. A start is the time from the start of the process to the line that says that the node is
ready; the smallest of RUNS (default 50), as a ratio to a static program that does nothing. Memory is
the largest that the process ever had (VmHWM), CPU time that of ten seconds in Pre-operational: in Operational some devices send
each millisecond.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

SHEETS = sorted((Path(__file__).resolve().parents[1] / "eds").glob("*.eds"))
NODES, IDLE_SECONDS = 20, 10


@contextmanager
def running(*command: str):
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def floor_ms(program: str, runs: int) -> float:
    def once() -> float:
        before = time.perf_counter()
        subprocess.run([program], check=True)
        return (time.perf_counter() - before) * 1000

    return min(once() for _ in range(runs))


def start_ms(edsc: str, bus: str, sheet: Path, runs: int) -> float:
    def once() -> float:
        before = time.perf_counter()
        with running(edsc, "node", bus, str(sheet), "--node-id", "5") as process:
            line = process.stdout.readline()
            spent = (time.perf_counter() - before) * 1000
        if not line.startswith("node 5 "):
            sys.exit(f"edsc node {sheet.name}: {line!r}")
        return spent

    return min(once() for _ in range(runs))


def cpu_seconds(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def many(edsc: str, bus: str, sheet: Path) -> tuple[float, float]:
    """Returns MB and percent of a core."""
    command = (edsc, "node", bus, str(sheet), "--node-id", "1", "--count", str(NODES), "--set", "1017h=1000")
    with running(*command) as process:
        for _ in range(NODES):
            process.stdout.readline()
        time.sleep(1)
        before = cpu_seconds(process.pid)
        time.sleep(IDLE_SECONDS)
        spent = cpu_seconds(process.pid) - before
        peak = int(re.search(r"VmHWM:\s*(\d+)", Path(f"/proc/{process.pid}/status").read_text())[1])
    return peak / 1024, spent / IDLE_SECONDS * 100


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    edsc, floor = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
    runs = int(sys.argv[3]) if len(sys.argv) > 3 else 50
    with running(edsc, "bus", "--listen", "127.0.0.1:0") as server:
        bus = re.search(r"socketcand:\S+", server.stdout.readline())[0]
        nothing = floor_ms(floor, runs)
        print(f"{'process_floor':16} {nothing:6.2f} ms")
        for sheet in SHEETS:
            started = start_ms(edsc, bus, sheet, runs)
            print(f"{sheet.name:16} {started:6.2f} ms to be ready, {started / nothing:5.1f} times process_floor")
        for sheet in SHEETS:
            memory, load = many(edsc, bus, sheet)
            print(f"{NODES} x {sheet.name:16} {memory:6.1f} MB, {load:5.2f} % of a core with heartbeats each second")


if __name__ == "__main__":
    main()
