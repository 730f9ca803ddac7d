"""A raw CAN socket of the kernel, and common functions of the tests in the virtual machine, without code of edsc."""

from __future__ import annotations

import errno
import os
import signal
import socket
import struct
import subprocess
import sys
import time

FRAME = struct.Struct("=IB3x8s")


class Bus:
    def __init__(self, interface: str) -> None:
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((interface,))

    def close(self) -> None:
        self.socket.close()

    def send(self, can_id: int, data: str = "") -> None:
        payload = bytes.fromhex(data)
        self.socket.send(FRAME.pack(can_id, len(payload), payload.ljust(8, b"\0")))

    def drain(self) -> None:
        """Discards the frames received until now."""
        self.socket.setblocking(False)
        try:
            while self.socket.recv(FRAME.size):
                pass
        except OSError as problem:
            if problem.errno not in (errno.EAGAIN, errno.ENETDOWN):
                raise

    def ask(self, can_id: int, data: str, answer: int, seconds: float = 300.0) -> str:
        """Sends a frame and returns the first one after it with the CAN-ID `answer`."""
        self.drain()
        self.send(can_id, data)
        return self.receive(answer, seconds)

    def receive(self, can_id: int, seconds: float = 300.0) -> str:
        """The data of the next frame with this CAN-ID as hexadecimal digits; ignores other frames."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                found, size, payload = FRAME.unpack(self.socket.recv(FRAME.size))
            except TimeoutError:
                break
            except OSError as problem:
                if problem.errno != errno.ENETDOWN:  # reported once after an interface was down
                    raise
                continue
            if found == can_id:
                return payload[:size].hex(" ").upper()
        return "nothing"


def expect(what: str, got: object, wanted: object) -> None:
    print(f"{'ok  ' if got == wanted else 'FAIL'} {what}: {got}", flush=True)
    if got != wanted:
        sys.exit(f"{what}: wanted {wanted}")


def run(command: str) -> str:
    """The output of a command, which must succeed."""
    result = subprocess.run(command.split(), capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{command}: ended with {result.returncode}: {result.stdout}{result.stderr}")
    return result.stdout


class Program:
    """A program that runs until it is stopped, with its CPU time."""

    def __init__(self, *arguments: str, piped: bool = False) -> None:
        self.process = subprocess.Popen(arguments, stdout=subprocess.PIPE if piped else None, text=True)

    def __enter__(self) -> Program:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.returncode is None:
            self.process.kill()

    def line(self) -> str:
        """The next line of its output, which must be piped."""
        return self.process.stdout.readline().strip()

    def cpu_seconds(self) -> float:
        """User and system time until now."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            fields = file.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def stop(self) -> int:
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=600)
