#!/usr/bin/env python3
"""Compares codecs of PdoLayout with hand-written ones: time and instructions per call, and their ratios.

    pdo_codec.py PDO_CODEC

Runs the program bench/pdo_codec.cpp twice: directly for the times, and under callgrind (valgrind) for the exact number of
instructions, printed after the times. `words` is a PDO of four objects in eight bytes, `odd` one of 1, 1, 33 and 12 bits.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

CALLS = 1000  # under callgrind
FUNCTION = re.compile(r"^(c?fn)=\((\d+)\)(?: (.*))?$")  # only the first occurrence of a number has a name


def times(program: str) -> dict[str, tuple[float, float]]:
    printed = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return {name: (float(typed), float(by_hand)) for name, typed, by_hand in map(str.split, printed.splitlines())}


def own_costs(profile: str) -> dict[str, int]:
    """Instructions of each function, without those of the functions that it calls."""
    names: dict[str, str] = {}
    costs: dict[str, int] = {}
    function, of_a_call = "", False
    for line in profile.splitlines():
        if match := FUNCTION.match(line):
            names.setdefault(match[2], match[3] or "")
            if match[1] == "fn":
                function = names[match[2]]
        elif line.startswith("calls="):
            of_a_call = True  # the next line has the cost of the callee
        elif re.match(r"^[+\-*\d]", line):
            if not of_a_call:
                costs[function] = costs.get(function, 0) + int(line.split()[1])
            of_a_call = False
    return costs


def instructions(program: str) -> dict[str, float]:
    """Instructions per call, by `typed::NAME` or `by_hand::NAME`."""
    with tempfile.TemporaryDirectory() as folder:
        profile = Path(folder) / "profile"
        subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", program, "1", str(CALLS)],
                       check=True, capture_output=True)
        costs = own_costs(profile.read_text(encoding="utf-8"))
    found = {}
    for function, cost in costs.items():
        if match := re.match(r"codec::((?:typed|by_hand)::\w+)", function):
            found[match[1]] = found.get(match[1], 0) + cost / CALLS
    return found


def main() -> None:
    program = sys.argv[1]
    counted = instructions(program) if shutil.which("valgrind") else {}
    if not counted:
        print("valgrind is not installed: no instructions are counted")
    print(f"{'':14}{'typed':>9}{'by hand':>11}{'ratio':>8}" + f"{'typed':>9}{'by hand':>9}{'ratio':>8}" * bool(counted))
    for name, (typed, by_hand) in times(program).items():
        row = f"{name:14}{typed:6.2f} ns{by_hand:8.2f} ns{typed / by_hand:8.2f}"
        if counted:
            a, b = counted[f"typed::{name}"], counted[f"by_hand::{name}"]
            row += f"{a:9.0f}{b:9.0f}{a / b:8.2f}"
        print(row)


if __name__ == "__main__":
    main()
