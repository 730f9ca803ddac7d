#!/usr/bin/env python3
"""A drive on a real SocketCAN interface: boot-up, SDO, NMT, PDOs and heartbeat, as frames on vcan0.

    socketcan_drive_test.py PROGRAM        in a machine whose kernel has vcan0

Uses sockets of the kernel and no code of edsc: it receives what any other node would receive.
"""

from __future__ import annotations

import signal
import subprocess
import sys

from can_bus import Bus, expect

NODE = 5


def dialogue(bus: Bus) -> None:
    expect("boot-up", bus.receive(0x700 + NODE), "00")
    bus.send(0x600 + NODE, "40 00 10 00 00 00 00 00")
    expect("device type", bus.receive(0x580 + NODE), "43 00 10 00 92 01 42 00")
    bus.send(0x600 + NODE, "40 08 10 00 00 00 00 00")
    expect("device name, 9 bytes", bus.receive(0x580 + NODE), "41 08 10 00 09 00 00 00")
    bus.send(0x600 + NODE, "60 00 00 00 00 00 00 00")
    expect("first segment", bus.receive(0x580 + NODE), "00 54 43 31 2D 38 2F 32")
    bus.send(0x600 + NODE, "70 00 00 00 00 00 00 00")
    expect("last segment", bus.receive(0x580 + NODE), "1B 33 30 00 00 00 00 00")
    bus.send(0x600 + NODE, "2B 41 60 00 00 00 00 00")
    expect("statusword is read-only", bus.receive(0x580 + NODE), "80 41 60 00 02 00 01 06")
    bus.send(0x000, f"01 {NODE:02X}")
    expect("TPDO 1 on start", bus.receive(0x180 + NODE), "00 00")
    bus.send(0x200 + NODE, "06 00")
    expect("TPDO 1 answers RPDO 1", bus.receive(0x180 + NODE), "31 02")
    bus.send(0x600 + NODE, "2B 17 10 00 14 00 00 00")
    expect("heartbeat time written", bus.receive(0x580 + NODE), "60 17 10 00 00 00 00 00")
    for _ in range(3):
        expect("heartbeat", bus.receive(0x700 + NODE), "05")
    bus.send(0x000, "82 00")
    following = bus.receive(0x700 + NODE)
    while following == "05":  # a heartbeat that the drive sent before it received the command
        following = bus.receive(0x700 + NODE)
    expect("reset communication", following, "00")


def main() -> int:
    bus = Bus("vcan0")
    with subprocess.Popen([sys.argv[1], "vcan0", str(NODE)]) as program:
        try:
            dialogue(bus)
        finally:
            program.send_signal(signal.SIGTERM)
        expect("exit code after SIGTERM", str(program.wait(timeout=600)), "0")
    missing = subprocess.run([sys.argv[1], "can99", "5"], capture_output=True, text=True, check=False)
    expect("exit code without an interface", str(missing.returncode), "1")
    return 0


if __name__ == "__main__":
    sys.exit(main())
