"""A bus, nodes and clients for the tests of the commands for a live bus."""

from __future__ import annotations

import re
import socket
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

FRAME = re.compile(r"\((?P<time>[\d.]+)\) \w+ (?P<id>[0-9A-F]+)#(?P<data>[0-9A-FR]*)")


class Client:
    """A socketcand client; frames are written as `605 40 00 10 00 00 00 00 00`."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=600)
        self.heard = ""
        for command in ("", "< open vcan0 >", "< rawmode >"):
            self.socket.sendall(command.encode())
            self.message()

    def message(self) -> str:
        while ">" not in self.heard:
            more = self.socket.recv(4096)
            if not more:
                raise ConnectionError
            self.heard += more.decode()
        message, self.heard = self.heard.split(">", 1)
        return message.strip("< ").strip()

    def send(self, frame: str) -> None:
        can_id, *data = frame.split()
        self.socket.sendall(f"< send {can_id} {len(data)} {' '.join(data)} >".encode())

    def receive(self) -> str:
        while True:
            words = self.message().split()
            if words[0] == "frame":
                data = "".join(words[3:])
                return " ".join([words[1].rjust(3, "0")[-3:], *(data[i:i + 2] for i in range(0, len(data), 2))]).upper()

    def close(self) -> None:
        self.socket.close()


class Device(threading.Thread):
    """A node whose answers a test defines: `answer(frame)` returns the frames that it sends."""

    def __init__(self, client: Client, answer: Callable[[str], list[str]]) -> None:
        super().__init__(daemon=True)
        self.client, self.answer = client, answer
        self.start()

    def run(self) -> None:
        try:
            while True:
                for frame in self.answer(self.client.receive()):
                    self.client.send(frame)
        except OSError:
            pass


class Network:
    """`edsc bus`, and nodes of tests/fixtures/live_device.eds with these node-IDs; 255: a device without a node-ID."""

    def __init__(self, edsc: Path, live_nodes: Path, *nodes: int) -> None:
        self.bus = subprocess.Popen([edsc, "bus", "--listen", "127.0.0.1:0", "--log", "-"], text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.address = self.bus.stderr.readline().strip()
        self.port = int(re.search(r":(\d+)/", self.address)[1])
        self.log: list[str] = []
        self.reader = threading.Thread(target=self.read_log, daemon=True)
        self.reader.start()
        self.clients: list[Client] = []
        self.nodes = None
        if nodes:
            self.nodes = subprocess.Popen([live_nodes, self.address, *map(str, nodes)], text=True,
                                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            for _ in nodes:
                self.nodes.stdout.readline()

    def read_log(self) -> None:
        for line in self.bus.stdout:
            if frame := FRAME.fullmatch(line.strip()):
                data = frame["data"]
                self.log.append(" ".join([frame["id"], *(data[i:i + 2] for i in range(0, len(data), 2))]))

    def client(self) -> Client:
        self.clients.append(Client(self.port))
        return self.clients[-1]

    def device(self, answer: Callable[[str], list[str]]) -> Device:
        return Device(self.client(), answer)

    def frames(self, *can_ids: str) -> list[str]:
        """Ends the bus; returns all its frames, or those with these CAN-IDs."""
        self.close()
        return [frame for frame in self.log if not can_ids or frame.split()[0] in can_ids]

    def close(self) -> None:
        for client in self.clients:
            client.close()
        for process in (self.nodes, self.bus):
            if process is not None:
                process.terminate()
                process.wait(timeout=600)
        self.reader.join(timeout=600)
        for process in (self.nodes, self.bus):
            if process is not None:
                process.stdout.close()
                process.stderr.close()

    def __enter__(self) -> Network:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
