#!/usr/bin/env python3
"""Measures `edsc network check` and `simulate` with a network of 127 nodes.

    networks.py EDSC

A master without a file and 126 modules of eds/can-2053c.eds at 1 Mbit/s, each with a heartbeat and a TPDO to the master every
second. `simulate` generates, compiles and runs an hour; the first line has the wall time of all that.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SHEET = Path(__file__).resolve().parent.parent / "eds/can-2053c.eds"
MODULES = 126


def network() -> dict:
    modules = {f"module{number}": {"node_id": number, "eds": str(SHEET), "heartbeat_ms": 1000} for number in range(1, MODULES + 1)}
    signals = [{"from": name, "object": "6000h:01", "to": "control", "every_ms": 1000} for name in modules]
    control = {"node_id": 127, "master": True, "heartbeat_ms": 1000}
    return {"bit_rate": 1000, "nodes": {"control": control, **modules}, "signals": signals}


def measure(edsc: str, *arguments: str) -> str:
    begin, cpu = time.monotonic(), os.times()
    result = subprocess.run([edsc, "network", *arguments], capture_output=True, text=True)
    after = os.times()
    if result.returncode != 0:
        sys.exit(result.stderr)
    seconds = after.children_user - cpu.children_user + after.children_system - cpu.children_system
    print(f"network {arguments[0]}: {time.monotonic() - begin:.2f} s, {seconds:.2f} s of CPU")
    return result.stdout


def main() -> None:
    edsc = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "line.json"
        path.write_text(json.dumps(network()))
        measure(edsc, "check", str(path))
        print("\n".join(measure(edsc, "simulate", str(path), "--for", "1h").splitlines()[:2]))


if __name__ == "__main__":
    main()
