#!/usr/bin/env python3
"""edsc's master boots slaves without edsc's code, on a bus of `edsc bus`: those of slaves.py, each with a behaviour that occurs
in plants, and npm's canopen.

    foreign_slaves_test.py --edsc EDSC --master BOOT_MASTER [--node-canopen WORK_DIR]

Without --node-canopen, or if npm cannot install it, its slave is skipped with a message.
"""

from __future__ import annotations

import argparse
import re
import select
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from masters_test import Skipped, end_with_parent, install_node_canopen  # noqa: E402
from slaves import Habits, Slave  # noqa: E402

LIMIT = 1200.0  # seconds, for programs that hang

PLAIN, NO_HEARTBEAT, NEAR, BEYOND, REPLACED, TWICE, SILENT, RESETS, LOST, NPM = range(1, 11)


class Bus:
    """A client of `edsc bus` that all slaves of this process share."""

    def __init__(self, address: str) -> None:
        host, port, name = re.fullmatch(r"socketcand:([^:]+):(\d+)/(\w+)", address).groups()
        self.socket = socket.create_connection((host, int(port)))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.text = b""
        for request in (b"", f"< open {name} >".encode(), b"< rawmode >"):
            self.socket.sendall(request)
            while b">" not in self.text:
                self.text += self.socket.recv(4096)
            self.text = self.text.split(b">", 1)[1]

    def receive(self, seconds: float) -> list[tuple[int, bytes]]:
        if select.select([self.socket], [], [], seconds)[0]:
            self.text += self.socket.recv(65536)
        *elements, self.text = self.text.split(b">")
        frames = []
        for element in elements:
            words = element.decode().strip(" <").split()
            if words and words[0] == "frame":
                frames.append((int(words[1], 16), bytes.fromhex("".join(words[3:]))))
        return frames

    def send(self, can_id: int, data: bytes) -> None:
        text = "".join(f" {byte:X}" for byte in data)
        self.socket.sendall(f"< send {can_id:X} {len(data)}{text} >".encode())


class Plant:
    def __init__(self, address: str, slaves: list[Slave]) -> None:
        self.bus = Bus(address)
        self.slaves = slaves

    def run(self) -> None:
        """Serves all slaves once. They do not receive each other's frames: none of those is for a slave."""
        for can_id, data in self.bus.receive(0.01):
            for slave in self.slaves:
                slave.take(can_id, data, time.monotonic())
        for slave in self.slaves:
            for can_id, data in slave.due(time.monotonic()):
                self.bus.send(can_id, data)


class Log:
    """The output of the master."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def lines(self) -> list[str]:
        return self.file.read_text(encoding="utf-8").splitlines()

    def has(self, *wanted: str) -> bool:
        """Returns whether the output has these lines in this order; other lines may be between them."""
        lines = iter(self.lines())
        return all(any(line == one for line in lines) for one in wanted)


WANTED = {
    "a plain slave": ["node 1: boot-up", "node 1: booted"],
    "no 1017h": ["node 2: no heartbeat when error control was started: 1017h:00: 0602 0000h, object does not exist"],
    "answers near the time-out": ["node 3: booted"],
    "answers beyond the time-out": [
        "node 4: no answer, or device type 1000h could not be read: 1000h:00: 0504 0000h, SDO protocol timed out",
        "node 4: booted"],
    "another product": ["node 5: product code 1018h:02 is not the one of 1F86h: expected 00010001h, seen 00020002h"],
    "two boot-up messages": ["node 6: boot-up", "node 6: boot-up", "node 6: booted"],
    "no answer": ["node 7: no answer, or device type 1000h could not be read: 1000h:00: 0504 0000h, SDO protocol timed out"],
    "a reset in the middle": ["node 8: boot-up", "node 8: boot-up", "node 8: booted"],
    "lost, and back": ["node 9: booted", "node 9: lost, last state operational", "node 9: boot-up", "node 9: booted"],
}
NEVER = [f"node {node_id}: booted" for node_id in (NO_HEARTBEAT, REPLACED, SILENT)]


def longer(node_id: int) -> bytes:
    return bytes(ord("a") + (node_id + i) % 26 for i in range(20))


def boot(arguments: argparse.Namespace, address: str, with_npm: bool) -> list[str]:
    """Returns the problems."""
    slaves = [
        Slave(PLAIN), Slave(NO_HEARTBEAT, Habits(has_heartbeat=False)), Slave(NEAR, Habits(delay=1.2)),
        Slave(BEYOND, Habits(delay=2.5, delayed_answers=2)), Slave(REPLACED, Habits(product=0x20002)),
        Slave(TWICE, Habits(boot_ups=2)), Slave(SILENT, Habits(silent=True)), Slave(RESETS, Habits(resets_at_write=True)),
        Slave(LOST, Habits(dies_after=8.0)),
    ]
    plant = Plant(address, slaves)
    wanted = dict(WANTED)
    nodes = [f"{slave.node_id}:heartbeat=3000" for slave in slaves]
    nodes[REPLACED - 1] += ":product=0x10001"
    if with_npm:
        nodes.append(f"{NPM}:heartbeat=3000")
        wanted["npm's canopen, which has no boot-up message"] = [f"node {NPM}: booted"]
    with tempfile.TemporaryDirectory() as folder:
        log = Log(Path(folder) / "log")
        with open(log.file, "w", encoding="utf-8") as output:
            master = subprocess.Popen([arguments.master, address, *nodes], stdout=output, preexec_fn=end_with_parent)
        try:
            end = time.monotonic() + LIMIT
            while not all(log.has(*lines) for lines in wanted.values()) and time.monotonic() < end:
                assert master.poll() is None, f"the master ended with {master.returncode}"
                until = time.monotonic() + 0.2
                while time.monotonic() < until:
                    plant.run()
        finally:
            master.terminate()
            master.wait(600)
        problems = [f"{what}: no {lines}" for what, lines in wanted.items() if not log.has(*lines)]
        problems += [f"not expected: {line}" for line in NEVER if log.has(line)]
        for slave in slaves:
            if f"node {slave.node_id}: booted" in log.lines():
                values = (slave.entries[(0x2000, 0)], slave.entries[(0x2001, 0)])
                if values != (b"\x34\x12", longer(slave.node_id)):
                    problems.append(f"node {slave.node_id} holds {values}")
        if problems:
            problems += ["---- the master's log", *log.lines()]
    for what in wanted:
        if not problems:
            print(f"ok   {what}")
    return problems


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--edsc", type=Path, required=True)
    parser.add_argument("--master", type=Path, required=True)
    parser.add_argument("--node-canopen", type=Path)
    arguments = parser.parse_args()
    begin = time.monotonic()
    programs = []
    try:
        bus = subprocess.Popen([arguments.edsc, "bus", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True,
                               preexec_fn=end_with_parent)
        programs.append(bus)
        address = re.search(r"socketcand:\S+", bus.stdout.readline())[0]
        with_npm = arguments.node_canopen is not None
        if with_npm:
            try:
                slave = install_node_canopen(arguments.node_canopen).with_name("slave.js")
                npm = subprocess.Popen(["node", slave, address, str(NPM)], stdout=subprocess.PIPE, text=True,
                                       preexec_fn=end_with_parent)
                programs.append(npm)
                assert npm.stdout.readline().strip() == "started"
            except Skipped as reason:
                print(f"skipped: npm's canopen: {reason}")
                with_npm = False
        problems = boot(arguments, address, with_npm)
    finally:
        for program in reversed(programs):
            program.kill()
            program.wait()
    print("\n".join(problems), end="\n" if problems else "")
    print(f"{time.monotonic() - begin:.1f} s")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
