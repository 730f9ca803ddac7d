#!/usr/bin/env python3
"""Plays traces with the runnable nodes as processes on `edsc bus`, in real time, byte for byte.

    live_replay_test.py SOURCE_DIR EDSC NODES_DIR [TRACE...]

Only for traces of one application that do not check times below a millisecond: the expected frames must be received in
order, however late. Lines of trace.hpp that are not supported here: `=`, `emergency` and `power`.
"""

from __future__ import annotations

import re
import socket
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE, EDSC, NODES = (Path(argument).resolve() for argument in sys.argv[1:4])
TRACES = sys.argv[4:] or ["001-states-in-homing", "001-states-in-profile-position", "002-6.2.3-homing",
                          "002-6.3.4-manual-movement"]
ADDRESS = re.compile(r"socketcand:127\.0\.0\.1:(\d+)/(\w+)\n")
FRAME = re.compile(rb"< frame ([0-9A-F]+) [0-9.]+ ([0-9A-F]*) >")
LATEST = 120.0  # s until a frame must be received
ATTEMPTS = 3


class Bus:
    """A client in raw mode."""

    def __init__(self, port: int, name: str) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=LATEST)
        self.text = b""
        self.wait_for(b"< hi >")
        for command in (f"< open {name} >", "< rawmode >"):
            self.socket.sendall(command.encode())
            self.wait_for(b"< ok >")

    def wait_for(self, answer: bytes) -> None:
        while answer not in self.text:
            self.text += self.socket.recv(4096)
        self.text = self.text.split(answer, 1)[1]

    def send(self, can_id: str, data: list[str]) -> None:
        self.socket.sendall(f"< send {can_id} {len(data)} {' '.join(data)} >".encode())

    def receive(self, seconds: float) -> tuple[int, list[str]] | None:
        end = time.monotonic() + seconds
        while True:
            if match := FRAME.search(self.text):
                self.text = self.text[match.end():]
                digits = match[2].decode()
                return int(match[1], 16), [digits[i:i + 2] for i in range(0, len(digits), 2)]
            left = end - time.monotonic()
            if left <= 0:
                return None
            self.socket.settimeout(left)
            try:
                self.text += self.socket.recv(4096)
            except TimeoutError:
                return None


class Replay:
    def __init__(self, trace: str, bus: Bus, process: subprocess.Popen, node_id: int) -> None:
        self.trace, self.bus, self.process, self.node_id = trace, bus, process, node_id
        self.disregarded: set[int] = set()
        self.early: list[tuple[int, list[str]]] = []  # received while `read` waited for its answer
        self.until = 0.0  # time of the next stimulus
        self.frames = 0

    def receive(self, seconds: float) -> tuple[int, list[str]] | None:
        return self.early.pop(0) if self.early else self.bus.receive(seconds)

    def expect(self, can_id: int, data: list[str]) -> None:
        while True:
            got = self.receive(max(LATEST, self.until - time.monotonic() + LATEST))
            if got is None:
                raise AssertionError(f"expected {can_id:03X} {' '.join(data)}, got nothing")
            same = got[0] == can_id and len(got[1]) == len(data)
            if same and all(want in ("--", byte) for want, byte in zip(data, got[1])):
                self.frames += 1
                return
            if got[0] not in self.disregarded:
                raise AssertionError(f"expected {can_id:03X} {' '.join(data)}, got {got[0]:03X} {' '.join(got[1])}")

    def be_silent(self) -> None:
        """Waits until `until`; only disregarded frames may be received."""
        while (left := self.until - time.monotonic()) > 0:
            got = self.receive(left)
            if got and got[0] not in self.disregarded:
                raise AssertionError(f"not expected: {got[0]:03X} {' '.join(got[1])}")

    def read(self, place: str, value: str) -> None:
        index, sub_index = int(place[:4], 16), int(place[6:], 16)
        self.bus.send(f"{0x600 + self.node_id:X}",
                      ["40", f"{index & 0xFF:02X}", f"{index >> 8:02X}", f"{sub_index:02X}", "00", "00", "00", "00"])
        while True:
            got = self.bus.receive(LATEST)
            if got is None:
                raise AssertionError(f"{place} is not answered")
            if got[0] == 0x580 + self.node_id:
                break
            self.early.append(got)
        size = 4 - (int(got[1][0], 16) >> 2 & 3)
        found = int.from_bytes(bytes.fromhex("".join(got[1][4:4 + size])), "little")
        if found != int(value, 0) % (1 << 8 * size):
            raise AssertionError(f"{place} is {found}")

    def play(self) -> None:
        for number, text in enumerate(self.trace.splitlines(), 1):
            words = text.split("#")[0].split()
            if not words or words[0] in ("manual", "application", "node"):
                continue
            try:
                self.line(words)
            except AssertionError as problem:
                raise AssertionError(f"line {number}: {problem}") from None

    def line(self, words: list[str]) -> None:
        match words:
            case ["+", count, unit]:
                self.until = time.monotonic() + int(count) * {"us": 1e-6, "ms": 1e-3, "s": 1.0}[unit]
            case ["~", can_id]:
                self.disregarded.add(int(can_id, 16))
            case ["<", can_id, *data]:
                self.expect(int(can_id, 16), data)
            case [">", can_id, *data]:
                self.be_silent()
                self.bus.send(can_id, data)
            case ["!", *line]:
                self.be_silent()
                self.process.stdin.write(" ".join(line) + "\n")
                self.process.stdin.flush()
                time.sleep(0.05)  # until the node has read it; a frame would be faster
            case ["read", place, value]:
                self.be_silent()
                self.read(place, value)
            case _:
                raise AssertionError(f"not understood: {' '.join(words)}")


def head(trace: str, key: str) -> str:
    return re.search(rf"^{key} +(\S+)", trace, re.MULTILINE)[1]


def replay(name: str, address: re.Match[str]) -> str:
    """Returns what went wrong, or an empty text if the frames are those of the trace. A state of a few ms is not sent by a node
    that a busy machine calls late: only what goes wrong each time is a problem."""
    problem = ""
    for _ in range(ATTEMPTS):
        try:
            play(name, int(address[1]), address[2])
            return ""
        except AssertionError as error:
            problem = f"{name}: {error}"
            print(problem)
    return problem


def play(name: str, port: int, bus_name: str) -> None:
    trace = (SOURCE / "tests/traces" / f"{name}.trace").read_text(encoding="utf-8")
    node_id = int(head(trace, "node"))
    bus = Bus(port, bus_name)
    program = NODES / head(trace, "application").replace("-", "_")
    with subprocess.Popen([program, f"socketcand:127.0.0.1:{port}/{bus_name}", "--node-id", str(node_id)], text=True,
                          stdin=subprocess.PIPE, stdout=subprocess.DEVNULL) as process:
        try:
            if bus.receive(LATEST) != (0x700 + node_id, ["00"]):
                raise AssertionError("no boot-up message")
            player = Replay(trace, bus, process, node_id)
            player.play()
            print(f"{name}: {player.frames} frames as in the trace")
        finally:
            process.terminate()


def main() -> int:
    command = [EDSC, "bus", "--listen", "127.0.0.1:0"]
    for i in range(len(TRACES)):
        command.append(f"vcan{i}")
    with subprocess.Popen(command, text=True, stdout=subprocess.PIPE) as server:
        try:
            addresses = [ADDRESS.fullmatch(server.stdout.readline()) for _ in TRACES]
            with ThreadPoolExecutor() as pool:
                problems = [problem for problem in pool.map(replay, TRACES, addresses) if problem]
        finally:
            server.terminate()
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
