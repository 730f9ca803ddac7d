#!/usr/bin/env python3
"""Prints the time of `edsc check` for each reference device, from the start of the process to its end, and its ratio to a static
program that does nothing.

    start_time.py EDSC PROCESS_FLOOR [RUNS]

The times are the smallest of RUNS (default 200), since other work of the machine only adds to them: wall time, and user and system
time of the process. The ratio is that of the wall times.
"""

from __future__ import annotations

import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path

SHEETS = sorted((Path(__file__).resolve().parents[1] / "eds").glob("*.eds"))
QUIET = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0), (os.POSIX_SPAWN_OPEN, 2, os.devnull, os.O_WRONLY, 0)]


@dataclass
class Times:
    """The smallest times in ms."""

    wall: float = float("inf")
    cpu: float = float("inf")

    def run(self, command: tuple[str, ...]) -> None:
        before = time.perf_counter()
        process = os.posix_spawn(command[0], command, os.environ, file_actions=QUIET)
        _, status, usage = os.wait4(process, 0)
        self.wall = min(self.wall, (time.perf_counter() - before) * 1000)
        self.cpu = min(self.cpu, (usage.ru_utime + usage.ru_stime) * 1000)
        if status != 0:
            sys.exit(f"{' '.join(command)}: status {status}")


def main() -> None:
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    edsc, floor = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
    commands = {"process_floor": (floor,), **{f"edsc check {sheet.name}": (edsc, "check", str(sheet)) for sheet in SHEETS}}
    times = {name: Times() for name in commands}
    for _ in range(int(sys.argv[3]) if len(sys.argv) > 3 else 200):
        for name, command in commands.items():
            times[name].run(command)
    for name, found in times.items():
        print(f"{name:28} {found.wall:6.2f} ms, {found.cpu:6.2f} ms of CPU, {found.wall / times['process_floor'].wall:5.1f} times "
              "process_floor")


if __name__ == "__main__":
    main()
