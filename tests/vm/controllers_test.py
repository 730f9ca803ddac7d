#!/usr/bin/env python3
"""Nodes on two CAN controllers of one bus; `ip link` sets the bit rate.

    controllers_test.py VM_NODE VM_CLIENT VM_FRAMES     in a machine with can0 and can1
"""

from __future__ import annotations

import sys

from can_bus import Bus, Program, expect, run

CONTROLLERS = ("can0", "can1")


def set_bit_rate(bit_rate: int) -> None:
    for name in CONTROLLERS:
        run(f"ip link set {name} down")
        run(f"ip link set {name} up type can bitrate {bit_rate} restart-ms 100")


def main() -> int:
    vm_node, vm_client, vm_frames = sys.argv[1:]
    set_bit_rate(500_000)
    bus = Bus("can1")
    with Program(vm_node, "socketcan:can0", "7") as program:
        expect("boot-up", bus.receive(0x707), "00")
        expect("device type", bus.ask(0x607, "40 00 10 00 00 00 00 00", 0x587), "43 00 10 00 00 00 00 00")
        run(f"{vm_client} socketcan:can1 7")
        expect("heartbeat time", bus.ask(0x607, "2B 17 10 00 14 00 00 00", 0x587), "60 17 10 00 00 00 00 00")
        expect("heartbeat", bus.receive(0x707), "7F")
        set_bit_rate(125_000)
        expect("heartbeat at another bit rate", bus.receive(0x707), "7F")
        expect("exit code", program.stop(), 0)
    print(run(f"{vm_frames} socketcan:can0 socketcan:can1 2000"), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
