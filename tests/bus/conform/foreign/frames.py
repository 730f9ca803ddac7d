"""Frames, and a client of `edsc bus` in its protocol socketcand."""

from __future__ import annotations

import re
import select
import socket
from typing import NamedTuple

EXTENDED_DIGITS = 8  # of a CAN-ID with 29 bits


class Frame(NamedTuple):
    can_id: int
    data: bytes = b""
    remote: bool = False
    size: int = 0  # of a remote frame
    extended: bool = False  # a CAN-ID of 29 bits


class Bus:
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

    def receive(self, seconds: float, other: list[int] | None = None) -> list[Frame]:
        """Waits for frames, or for input of the file descriptors `other`. Raises ConnectionError when the bus ends."""
        if self.socket in select.select([self.socket, *(other or [])], [], [], seconds)[0]:
            piece = self.socket.recv(65536)
            if not piece:
                raise ConnectionError("the bus has ended")
            self.text += piece
        *elements, self.text = self.text.split(b">")
        frames = []
        for element in elements:
            words = element.decode().strip(" <").split()
            if not words or words[0] not in ("frame", "rtr"):
                continue
            can_id, extended = int(words[1], 16), len(words[1]) == EXTENDED_DIGITS
            if words[0] == "frame":
                frames.append(Frame(can_id, bytes.fromhex("".join(words[3:])), extended=extended))
            else:
                frames.append(Frame(can_id, remote=True, size=int(words[3], 16), extended=extended))
        return frames

    def send(self, frame: Frame) -> None:
        can_id = f"{frame.can_id:0{EXTENDED_DIGITS if frame.extended else 3}X}"
        if frame.remote:
            self.socket.sendall(f"< sendrtr {can_id} {frame.size} >".encode())
        else:
            text = "".join(f" {byte:X}" for byte in frame.data)
            self.socket.sendall(f"< send {can_id} {len(frame.data)}{text} >".encode())
