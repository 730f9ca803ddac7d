"""Frames, and a client of `edsc bus` in its protocol socketcand."""

from __future__ import annotations

import re
import select
import socket
from typing import NamedTuple


class Frame(NamedTuple):
    can_id: int
    data: bytes = b""
    remote: bool = False
    size: int = 0  # of a remote frame


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
            if words and words[0] == "frame":
                frames.append(Frame(int(words[1], 16), bytes.fromhex("".join(words[3:]))))
            elif words and words[0] == "rtr":
                frames.append(Frame(int(words[1], 16), remote=True, size=int(words[3], 16)))
        return frames

    def send(self, frame: Frame) -> None:
        if frame.remote:
            self.socket.sendall(f"< sendrtr {frame.can_id:X} {frame.size} >".encode())
        else:
            text = "".join(f" {byte:X}" for byte in frame.data)
            self.socket.sendall(f"< send {frame.can_id:X} {len(frame.data)}{text} >".encode())
