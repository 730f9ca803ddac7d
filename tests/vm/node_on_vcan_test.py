#!/usr/bin/env python3
"""A node on vcan0: communication with can-utils and the client of the runtime, failure and recovery of its bus, CPU time.

    node_on_vcan_test.py VM_NODE VM_CLIENT      in a machine whose kernel has vcan0
"""

from __future__ import annotations

import re
import subprocess
import sys
import time

from can_bus import Bus, Program, expect, run

NODE = 5
ERROR = 0x2000_0000
CONTROLLER = ERROR | 0x004
BUS_OFF = ERROR | 0x040
RESTARTED = ERROR | 0x100
START = "01 05"


def listeners() -> int:
    """The number of sockets that receive all frames of vcan0."""
    with open("/proc/net/can/rcvlist_all", encoding="ascii") as file:
        return len(re.findall(r"^ *vcan0 ", file.read(), re.M))


def candump(seconds: float, *arguments: str) -> subprocess.Popen[str]:
    """Starts candump, which ends after this time without a frame."""
    before = listeners()
    command = ["candump", "-L", "-T", str(int(seconds * 1000)), *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    while listeners() == before:
        assert process.poll() is None, "candump has ended"
        time.sleep(0.05)
    return process


def frames_of(process: subprocess.Popen[str]) -> list[str]:
    """The frames in the format of candump -L, without time and interface."""
    return re.findall(r"\S+#\S*", process.communicate()[0])


def can_utils(bus: Bus) -> None:
    dump = candump(10.0, "vcan0")
    for frame in ("000#0105", "605#4000100000000000", "205#AA341200000000", "080#", "705#R", "606#4000100000000000"):
        run(f"cansend vcan0 {frame}")
    frames = frames_of(dump)
    for frame in ("605#4000100000000000", "585#4300100000000000", "185#AA341200"):
        expect(f"candump shows {frame}", frame in frames, True)
    expect("and TPDO 2 after the SYNC", sum(frame.startswith("285#") for frame in frames), 1)
    expect("and one answer to the guarding request", [f for f in frames if f.startswith("705#") and f != "705#R"], ["705#05"])
    expect("and none of another node", [f for f in frames if f.startswith("586#")], [])
    bus.send(0x000, "80 05")


def filters(bus: Bus) -> None:
    """The filter list of the kernel: a node does not receive frames that it does not use."""
    expect("SDO", bus.ask(0x605, "40 00 10 00 00 00 00 00", 0x585), "43 00 10 00 00 00 00 00")
    with open("/proc/net/can/rcvlist_sff", encoding="ascii") as file:
        listed = set(re.findall(r"^ *vcan0 +([0-9a-f]{3}) ", file.read(), re.M))
    expect("filters of the node", {"000", "080", "205", "305", "605"} <= listed and "585" not in listed, True)
    expect("RPDO 1 is made invalid", bus.ask(0x605, "23 00 14 01 05 02 00 80", 0x585), "60 00 14 01 00 00 00 00")
    expect("RPDO 1 gets another CAN-ID", bus.ask(0x605, "23 00 14 01 34 02 00 00", 0x585), "60 00 14 01 00 00 00 00")
    bus.send(0x000, START)
    bus.receive(0x185)
    expect("its frames reach the node", bus.ask(0x234, "BB 34 12 00 00 00 00", 0x185), "BB 34 12 00")
    expect("those of the old one do not", bus.ask(0x205, "CC 34 12 00 00 00 00", 0x185, 0.2), "nothing")
    expect("a reset brings the old one back", bus.ask(0x000, "82 05", 0x705), "00")
    bus.send(0x000, START)
    bus.receive(0x185)
    expect("whose frames reach the node again", bus.ask(0x205, "DD 34 12 00 00 00 00", 0x185), "DD 34 12 00")


def error_frames(bus: Bus) -> None:
    expect("error passive", bus.ask(CONTROLLER, "00 10 00 00 00 00 00 00", 0x085), "20 81 11 00 00 00 00 00")
    expect("error active again", bus.ask(CONTROLLER, "00 08 00 00 00 00 00 00", 0x085), "00 00 00 00 00 00 00 00")
    expect("overrun", bus.ask(CONTROLLER, "00 01 00 00 00 00 00 00", 0x085), "10 81 11 00 00 00 00 00")
    expect("no more of it for a second", bus.receive(0x085, 60), "00 00 00 00 00 00 00 00")


def bus_off(bus: Bus, program: Program) -> None:
    expect("heartbeat every 50 ms", bus.ask(0x605, "2B 17 10 00 32 00 00 00", 0x585), "60 17 10 00 00 00 00 00")
    expect("in Operational", bus.receive(0x705), "05")
    bus.send(BUS_OFF, "00 00 00 00 00 00 00 00")
    time.sleep(2.0)
    while bus.receive(0x705, 0.01) != "nothing":
        pass
    before = program.cpu_seconds()
    expect("silence while the controller is off the bus", bus.receive(0x705, 0.6), "nothing")
    expect("and rest", program.cpu_seconds() - before < 0.3, True)
    expect("EMCY after bus-off", bus.ask(RESTARTED, "00 00 00 00 00 00 00 00", 0x085), "40 81 11 00 00 00 00 00")
    expect("EMCY when it is over", bus.receive(0x085), "00 00 00 00 00 00 00 00")
    expect("bus-off is a communication error: Pre-operational", bus.receive(0x705), "7F")


def interface_down(bus: Bus, program: Program) -> None:
    run("ip link set vcan0 down")
    before = program.cpu_seconds()
    time.sleep(0.5)
    expect("rest while the interface is down", program.cpu_seconds() - before < 0.3, True)
    run("ip link set vcan0 up")
    expect("heartbeat when it is up again", bus.receive(0x705), "7F")
    run("ip link delete vcan0")
    time.sleep(0.5)
    before = program.cpu_seconds()
    time.sleep(0.5)
    expect("rest while it is gone", program.cpu_seconds() - before < 0.3, True)
    run("ip link add vcan0 type vcan")
    run("ip link set vcan0 up")
    fresh = Bus("vcan0")
    expect("heartbeat on a new interface of that name", fresh.receive(0x705), "7F")
    expect("SDO there", fresh.ask(0x605, "40 00 10 00 00 00 00 00", 0x585), "43 00 10 00 00 00 00 00")
    fresh.close()


def node(vm_node: str, vm_client: str, *mode: str) -> None:
    bus = Bus("vcan0")
    with Program(vm_node, "socketcan:vcan0", str(NODE), *mode) as program:
        expect(f"boot-up {mode}", bus.receive(0x705), "00")
        if not mode:
            can_utils(bus)
            run(f"{vm_client} socketcan:vcan0 {NODE}")
            error_frames(bus)
        filters(bus)
        bus_off(bus, program)
        interface_down(bus, program)
        expect("exit code", program.stop(), 0)
    bus.close()


def main() -> int:
    vm_node, vm_client = sys.argv[1:]
    node(vm_node, vm_client)
    node(vm_node, vm_client, "serve")
    return 0


if __name__ == "__main__":
    sys.exit(main())
