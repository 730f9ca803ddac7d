#!/usr/bin/env python3
"""Masters with none of edsc's code walk over the eight reference nodes.

    masters_test.py --nodes DIR --eds DIR (--edsc EDSC | --bus ADDRESS) [--only NAME]

Starts the nodes, on a bus of `edsc bus` or the one of ADDRESS, and walks over them with python-can.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from data_sheet import DataSheet  # noqa: E402
from report import Report, read_exceptions, stale  # noqa: E402
from walk import Walk  # noqa: E402
from wire import Wire  # noqa: E402

# Name of the node's program and its data sheet, and its node-ID here.
NODES = {"can_2017c": 1, "can_2024c": 2, "can_2053c": 3, "can_2057c": 4, "cpc_tc1": 5, "cpd": 6, "ezd_1136": 7, "rk5c": 8}


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--nodes", type=Path, required=True)
    parser.add_argument("--eds", type=Path, required=True)
    parser.add_argument("--edsc", type=Path)
    parser.add_argument("--bus")
    parser.add_argument("--only")
    arguments = parser.parse_args()
    begin = time.monotonic()
    running: list[subprocess.Popen[str]] = []
    address = arguments.bus
    if address is None:
        bus = subprocess.Popen([arguments.edsc, "bus", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        running.append(bus)
        address = bus.stdout.readline().strip()
    exceptions = read_exceptions(HERE / "exceptions.tsv")
    wire = Wire(address)
    failed = 0
    try:
        for name, node_id in NODES.items():
            if arguments.only not in (None, name):
                continue
            started = time.monotonic()
            node = subprocess.Popen([arguments.nodes / name, address.split(":")[2].split("/")[0], str(node_id)],
                                    stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
            running.append(node)
            report = Report(name, exceptions)
            boot_up = wire.receive(0x700 + node_id, 5)
            report.check("boot-up", "power-on", str(boot_up), str(b"\0"))
            Walk(wire, DataSheet(arguments.eds / f"{name.replace('_', '-')}.eds", node_id), report).run()
            print(report.summary(), f"({time.monotonic() - started:.1f} s)", flush=True)
            failed += sum(report.failed.values())
    finally:
        for program in running:
            program.kill()
    unneeded = stale(exceptions) if arguments.only is None else []
    print("\n".join(unneeded))
    print(f"{time.monotonic() - begin:.1f} s")
    return 1 if failed or unneeded else 0


if __name__ == "__main__":
    sys.exit(main())
