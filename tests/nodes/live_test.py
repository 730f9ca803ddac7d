#!/usr/bin/env python3
"""The runnable nodes, the plant and its master as programs on a live bus.

    live_test.py SOURCE_DIR PROGRAMS...             on vcan0 of the kernel
    live_test.py --edsc EDSC SOURCE_DIR PROGRAMS...  on a bus of `edsc bus`

PROGRAMS: plant, plant_master and rk5c. The script receives what any other node would receive.
"""

from __future__ import annotations

import argparse
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

LATE = 600.0  # maximum seconds until a frame on a busy machine
EVENT_TIMER_OF_TPDO_2 = bytes.fromhex("2B 01 18 05")
CYCLE_MS = 500  # cycle and guard time of the master of the plant
REMOTE = 0x4000_0000


@dataclass(frozen=True)
class Frame:
    can_id: int
    data: bytes = b""
    remote: bool = False

    def __str__(self) -> str:
        return f"{self.can_id:03X}  {'R' if self.remote else self.data.hex(' ').upper()}"


class KernelBus:
    """vcan0."""

    layout = struct.Struct("=IB3x8s")
    address = "socketcan:vcan0"

    def __init__(self) -> None:
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind(("vcan0",))

    def send(self, frame: Frame) -> None:
        can_id = frame.can_id | (REMOTE if frame.remote else 0)
        self.socket.send(self.layout.pack(can_id, len(frame.data), frame.data.ljust(8, b"\0")))

    def receive(self, seconds: float) -> Frame | None:
        if not select.select([self.socket], [], [], max(0.0, seconds))[0]:
            return None
        can_id, size, data = self.layout.unpack(self.socket.recv(self.layout.size))
        return Frame(can_id & 0x7FF, data[:size] if not can_id & REMOTE else b"", bool(can_id & REMOTE))

    def close(self) -> None:
        self.socket.close()


class ServedBus:
    """A bus of `edsc bus`."""

    def __init__(self, edsc: str) -> None:
        self.server = subprocess.Popen([edsc, "bus", "--listen", "127.0.0.1:0"], stdout=subprocess.PIPE, text=True)
        self.address = re.search(r"socketcand:\S+", self.server.stdout.readline())[0]
        host, port, bus = re.fullmatch(r"socketcand:([^:]+):(\d+)/(\w+)", self.address).groups()
        self.socket = socket.create_connection((host, int(port)))
        self.text = ""
        for request in ("", f"< open {bus} >", "< rawmode >"):
            self.socket.sendall(request.encode())
            self.element(LATE)

    def element(self, seconds: float) -> str | None:
        end = time.monotonic() + seconds
        while ">" not in self.text:
            if not select.select([self.socket], [], [], max(0.0, end - time.monotonic()))[0]:
                return None
            self.text += self.socket.recv(4096).decode()
        element, self.text = self.text.split(">", 1)
        return element.strip(" <")

    def send(self, frame: Frame) -> None:
        data = "".join(f" {byte:X}" for byte in frame.data)
        text = f"< sendrtr {frame.can_id:X} 0 >" if frame.remote else f"< send {frame.can_id:X} {len(frame.data)}{data} >"
        self.socket.sendall(text.encode())

    def receive(self, seconds: float) -> Frame | None:
        element = self.element(seconds)
        if element is None:
            return None
        words = element.split()
        if words[0] == "rtr":
            return Frame(int(words[1], 16), remote=True)
        assert words[0] == "frame", element
        return Frame(int(words[1], 16), bytes.fromhex("".join(words[3:])))

    def close(self) -> None:
        self.socket.close()
        self.server.send_signal(signal.SIGTERM)
        self.server.wait(LATE)
        self.server.stdout.close()


class Program:
    """A program on the bus, its standard input and its log."""

    def __init__(self, *command: str) -> None:
        self.log = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=self.log, text=True)

    def say(self, line: str) -> None:
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        time.sleep(0.1)

    def lines(self) -> list[str]:
        with open(self.log.fileno(), closefd=False) as again:
            again.seek(0)
            return again.read().splitlines()

    def wait_for(self, line: str, count: int = 1, seconds: float = LATE) -> None:
        end = time.monotonic() + seconds
        while self.lines().count(line) < count:
            assert time.monotonic() < end, f"no line '{line}' in\n" + "\n".join(self.lines())
            time.sleep(0.05)

    def end(self) -> list[str]:
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(LATE)
        assert code == 0, f"{self.process.args[0]} ended with {code}"
        lines = self.lines()
        self.process.stdin.close()
        self.log.close()
        return lines


def expect(bus: KernelBus | ServedBus, wanted: Frame, seconds: float = LATE) -> None:
    got = bus.receive(seconds)
    assert got == wanted, f"wanted {wanted}, got {got}"


def ask(bus: KernelBus | ServedBus, request: str, answer: str) -> None:
    """Expects this answer as the next frame with its CAN-ID; ignores other frames."""
    bus.send(frame_of(request))
    wanted = frame_of(answer)
    end = time.monotonic() + LATE
    while (left := end - time.monotonic()) > 0:
        got = bus.receive(left)
        if got is not None and got.can_id == wanted.can_id:
            assert got == wanted, f"wanted {wanted}, got {got}"
            return
    raise AssertionError(f"no answer {wanted}")


def frame_of(text: str) -> Frame:
    words = text.split()
    if words[1:2] == ["R"]:
        return Frame(int(words[0], 16), remote=True)
    return Frame(int(words[0], 16), bytes.fromhex("".join(words[1:])))


def volts(raw: int) -> float:
    """Returns the middle of the voltages that a channel of the module converts to this number."""
    signed = raw - 0x1_0000 if raw >= 0x8000 else raw
    return (signed + (0.5 if signed > 0 else -0.5 if signed < 0 else 0.0) + 32768) / 65535 * 20 - 10


def next_frame(bus: KernelBus | ServedBus, seconds: float, cyclic: set[int], wanted: Frame | None = None) -> Frame | None:
    """Returns the next frame, but ignores TPDOs of an event timer that are not wanted: their times are not known."""
    end = time.monotonic() + seconds
    while True:
        got = bus.receive(max(0.0, end - time.monotonic()))
        if got is None or got == wanted or got.can_id not in cyclic:
            return got


def read(bus: KernelBus | ServedBus, node_id: int, entry: str, cyclic: set[int]) -> int:
    """Reads an INTEGER16 of a node, which has then processed all earlier frames."""
    index, sub_index = (int(part.rstrip("h"), 16) for part in entry.split(":"))
    bus.send(Frame(0x600 + node_id, bytes([0x40, index & 0xFF, index >> 8, sub_index, 0, 0, 0, 0])))
    answer = next_frame(bus, LATE, cyclic)
    assert answer is not None and answer.can_id == 0x580 + node_id, f"{entry}: got {answer}"
    return int.from_bytes(answer.data[4:6], "little")


def set_input(bus: KernelBus | ServedBus, plant: Program, node_id: int, entry: str, value: int, cyclic: set[int]) -> None:
    """Sets the voltage of a channel after all earlier frames, and waits until the node has measured it."""
    read(bus, node_id, entry, cyclic)
    plant.say(f"node {node_id} analogue {int(entry.split(':')[1], 16)} {volts(value):.6f}")
    end = time.monotonic() + LATE
    while (got := read(bus, node_id, entry, cyclic)) != value:
        assert time.monotonic() < end, f"{entry}: {got} in place of {value}"


def replay(bus: KernelBus | ServedBus, plant: Program, trace: Path) -> int:
    """Returns the number of frames that are as in the trace."""
    frames = 0
    span = 0.0  # time before the next line of the trace
    begun, due = 0.0, 0.0  # time of the last request; minimum time from it to the next frame
    cyclic: set[int] = set()  # CAN-IDs of TPDOs with a running event timer
    for number, line in enumerate(trace.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split("#")[0].split()
        if not words or words[0] in ("manual", "device", "node"):
            continue
        try:
            if words[0] == "+":
                passes = float(words[1]) * {"s": 1.0, "ms": 1e-3, "us": 1e-6}[words[2]]
                span, due = span + passes, due + passes
                continue
            frame = frame_of(" ".join(words[1:])) if words[0] in "<>" else None
            if words[0] == "<":
                got = next_frame(bus, span + LATE, cyclic, frame)
                assert got == frame, f"wanted {frame}, got {got}"
                assert span == 0.0 or time.monotonic() - begun > 0.95 * due, "too early"
                frames += 1
            else:
                silent = next_frame(bus, min(span, 0.2) if span else 0.0, cyclic)
                assert silent is None, f"not expected: {silent}"
                if words[0] == ">":
                    begun, due = time.monotonic(), 0.0
                    bus.send(frame)
                    frames += 1
                    if frame.data[:4] == EVENT_TIMER_OF_TPDO_2:
                        node_id, runs = frame.can_id - 0x600, frame.data[4:6] != bytes(2)
                        (cyclic.add if runs else cyclic.discard)(0x280 + node_id)
                elif words[0] == "=":
                    node, entry, value = words[2:5]
                    set_input(bus, plant, int(node), entry, int(value, 0), cyclic)
            span = 0.0
        except AssertionError as problem:
            raise AssertionError(f"{trace.name}:{number}: {problem}") from None
    return frames


def replay_the_worked_example(bus: KernelBus | ServedBus, arguments: argparse.Namespace) -> None:
    plant = Program(arguments.plant, bus.address)
    for node_id in (1, 2, 3, 4):
        expect(bus, Frame(0x700 + node_id, b"\0"))
    trace = Path(arguments.source) / "tests/traces/plant/003-5.2.3-four-modules.trace"
    print(f"ok   {replay(bus, plant, trace)} frames of {trace.name}")
    lines = plant.end()
    assert "can_2057c: digital 1 0x34" in lines and "can_2024c: analogue 1 5.000 V" in lines, lines
    assert "can_2053c: RUN on" in lines, lines


def run_master_and_plant(bus: KernelBus | ServedBus, arguments: argparse.Namespace) -> None:
    plant = Program(arguments.plant, bus.address)
    plant.wait_for("can_2017c: state pre-operational, node-ID 4")
    master = Program(arguments.plant_master, bus.address, str(CYCLE_MS))
    started = "all nodes are configured: started"
    master.wait_for(started)
    time.sleep(20 * CYCLE_MS / 1000)
    lost, starts = "node 1 is lost: outputs stop", master.lines().count(started)
    losses = master.lines().count(lost)
    plant.process.send_signal(signal.SIGSTOP)
    master.wait_for(lost, losses + 1)
    plant.process.send_signal(signal.SIGCONT)
    master.wait_for(started, starts + 1)
    time.sleep(4 * CYCLE_MS / 1000)
    unguarded = "can_2057c: outputs take their error values"
    times = plant.lines().count(unguarded)
    last = master.end()[-1]
    agreed, differed = map(int, re.fullmatch(r"inputs were as the outputs in (\d+) cycles, otherwise in (\d+)", last).groups())
    assert agreed >= 10 and agreed > differed, last
    print(f"ok   {last}")
    plant.wait_for(unguarded, times + 1)  # the master no longer guards
    plant.end()


def restart_the_sensor(bus: KernelBus | ServedBus, arguments: argparse.Namespace) -> None:
    with tempfile.TemporaryDirectory() as folder:
        command = (arguments.rk5c, bus.address, "--store", f"{folder}/rk5c", "--serial", "352391732")
        sensor = Program(*command)
        sensor.wait_for("state initialisation, node-ID none")
        bus.send(frame_of("7E5 04 01 00 00 00 00 00 00"))
        ask(bus, "7E5 5D 00 00 00 00 00 00 00", "7E4 5D 34 12 01 15 00 00 00")
        ask(bus, "7E5 11 07 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00")
        ask(bus, "7E5 17 00 00 00 00 00 00 00", "7E4 17 00 00 00 00 00 00 00")
        ask(bus, "7E5 04 00 00 00 00 00 00 00", "707 00")
        sensor.say("position 1 200000")
        ask(bus, "607 23 10 60 01 E8 03 00 00", "587 60 10 60 01 00 00 00 00")
        ask(bus, "607 23 10 10 01 73 61 76 65", "587 60 10 10 01 00 00 00 00")
        sensor.process.stdin.close()  # the sensor must keep running
        time.sleep(0.3)
        ask(bus, "607 40 20 60 01 00 00 00 00", "587 42 20 60 01 E8 03 00 00")
        sensor.end()

        sensor = Program(*command)
        expect(bus, frame_of("707 00"))
        sensor.say("position 1 200100")
        ask(bus, "607 40 20 60 01 00 00 00 00", "587 42 20 60 01 E9 03 00 00")
        sensor.say("power-cycle")
        ask(bus, "607 40 00 10 00 00 00 00 00", "587 42 00 10 00 96 01 0A 00")
        lines = sensor.end()
        assert lines.count("power on: rk5c on " + bus.address) == 2, lines
    print("ok   node-ID, preset and serial number outlive a restart")


def refuse_wrong_arguments(arguments: argparse.Namespace) -> None:
    for wrong in ([], ["nowhere"], ["socketcan:nowhere0"], ["socketcan:vcan0", "--node-id", "128"], ["a", "b"]):
        done = subprocess.run([arguments.rk5c, *wrong], capture_output=True, text=True, timeout=600)
        assert done.returncode == 2 and done.stderr.startswith("rk5c: "), (wrong, done)
    done = subprocess.run([arguments.rk5c, "--help"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0 and "position 1 12345" in done.stdout, done
    print("ok   wrong arguments, --help")


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("--edsc")
    for name in ("source", "plant", "plant_master", "rk5c"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    for test in (replay_the_worked_example, run_master_and_plant, restart_the_sensor):
        bus = ServedBus(arguments.edsc) if arguments.edsc else KernelBus()
        try:
            test(bus, arguments)
        finally:
            bus.close()
    refuse_wrong_arguments(arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
