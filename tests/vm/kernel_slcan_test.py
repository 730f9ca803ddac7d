#!/usr/bin/env python3
"""The SLCAN driver of the kernel on pseudo-terminals: with an adapter that has a node, and as an interface that accepts no more
frames while its line is not read.

    kernel_slcan_test.py VM_ADAPTER VM_URGENT      in a machine whose kernel has slcan
"""

from __future__ import annotations

import fcntl
import os
import pty
import select
import struct
import subprocess
import sys
import termios
import time
import tty

from can_bus import Bus, Program, expect, run

SLCAN_DISCIPLINE = 17
SIOCGIFNAME = 0x8910


def attach(line: int) -> str:
    """Attaches a CAN interface to a serial line and returns its name."""
    tty.setraw(line)
    fcntl.ioctl(line, termios.TIOCSETD, struct.pack("i", SLCAN_DISCIPLINE))
    return fcntl.ioctl(line, SIOCGIFNAME, bytes(16)).rstrip(b"\0").decode()


def node_behind_an_adapter(vm_adapter: str) -> None:
    with Program(vm_adapter, "5", piped=True) as program:
        line = os.open(program.line(), os.O_RDWR | os.O_NOCTTY)
        interface = attach(line)
        bus = Bus(interface)
        run(f"ip link set {interface} up type can bitrate 500000")
        expect("boot-up, when the driver has opened the channel", bus.receive(0x705), "00")
        expect("SDO", bus.ask(0x605, "40 00 10 00 00 00 00 00", 0x585), "43 00 10 00 00 00 00 00")
        bus.send(0x000, "01 05")
        expect("TPDO 1 on start", bus.receive(0x185), "00 00 00 00")
        expect("TPDO 1", bus.ask(0x205, "AA 34 12 00 00 00 00", 0x185), "AA 34 12 00")
        run(f"cansend {interface} 705#R")
        expect("a remote frame", bus.receive(0x705), "05")
        bus.close()
        os.close(line)
        expect("exit code", program.stop(), 0)


def frames_of(line: int, program: subprocess.Popen[str]) -> list[str]:
    """The frames on the line until the program has ended."""
    text = b""
    while program.poll() is None or select.select([line], [], [], 2.0)[0]:
        if select.select([line], [], [], 0.1)[0]:
            text += os.read(line, 256)
    return [found for found in text.decode().split("\r") if found.startswith("t")]


def urgent_frames(vm_urgent: str, queue_length: int) -> None:
    """The kernel's ENOBUFS and EAGAIN: a queue of 2 frames is full before the socket is, one of 10 is not."""
    line, slave = pty.openpty()
    interface = attach(slave)
    run(f"ip link set {interface} txqueuelen {queue_length}")
    run(f"ip link set {interface} up")
    with Program(vm_urgent, f"socketcan:{interface}", piped=True) as program:
        late = int(program.line())
        frames = frames_of(line, program.process)
        expect(f"exit code with a queue of {queue_length}", program.process.returncode, 0)
    for can_id, count in (("t701", late), ("t081", 8)):
        numbers = [int(frame[5:9], 16) for frame in frames if frame.startswith(can_id)]
        expect(f"{count} frames {can_id[1:]}: each once and in order", numbers == list(range(count)), True)
    behind = frames[frames.index("t08120007") + 1:]
    expect("urgent frames overtake those that wait", len(behind), 40)
    os.close(slave)
    os.close(line)
    time.sleep(0.1)


def main() -> int:
    vm_adapter, vm_urgent = sys.argv[1:]
    node_behind_an_adapter(vm_adapter)
    urgent_frames(vm_urgent, 10)
    urgent_frames(vm_urgent, 2)
    return 0


if __name__ == "__main__":
    sys.exit(main())
