#!/usr/bin/env python3
"""A program that is the device of device.py on a bus of `edsc bus`, with a behaviour of behaviours.py.

    slave.py ADDRESS NODE_ID [BEHAVIOUR]

Lines of the standard input are stimuli: change, error, error_over, power_cycle.
"""

from __future__ import annotations

import os
import select
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from foreign.behaviours import switches_of  # noqa: E402
from foreign.device import Device  # noqa: E402
from foreign.frames import Bus  # noqa: E402

STIMULI = 0  # file descriptor


def stimuli() -> list[str]:
    """Returns the lines that are there now."""
    return os.read(STIMULI, 4096).decode().split() if select.select([STIMULI], [], [], 0)[0] else []


def main() -> None:
    address, node_id, *name = sys.argv[1:]
    bus = Bus(address)
    devices = [Device(HERE / "device.eds", int(node_id), switches) for switches in switches_of(name[0] if name else "")]
    for device in devices:
        device.start(time.monotonic())
    print("started", flush=True)
    while not devices[0].ended:
        for device in devices:
            for frame in device.poll(time.monotonic()):
                bus.send(frame)
        wait = min(device.deadline() for device in devices) - time.monotonic()
        for frame in bus.receive(max(0.0, wait), [STIMULI]):
            for device in devices:
                device.receive(frame, time.monotonic())
        for line in stimuli():
            devices[0].stimulate(line, time.monotonic())


if __name__ == "__main__":
    main()
