"""A CAN bus by its address, over python-can; frames wait until they are requested by their CAN-ID."""

from __future__ import annotations

import logging
import re
import time
from collections import deque

import can

SOCKETCAND = re.compile(r"socketcand:([^/]+):(\d+)/(\w+)")


class Wire:
    def __init__(self, address: str) -> None:
        if match := SOCKETCAND.fullmatch(address):
            options = {"interface": "socketcand", "host": match[1], "port": int(match[2]), "channel": match[3]}
            logging.getLogger("can.interfaces.socketcand").setLevel(logging.ERROR)
        elif address.startswith("slcan:"):
            options = {"interface": "slcan", "channel": address.removeprefix("slcan:"), "sleep_after_open": 0}
        else:
            options = {"interface": "socketcan", "channel": address.removeprefix("socketcan:")}
        self.socketcand = options["interface"] == "socketcand"
        self.socketcan = options["interface"] == "socketcan"
        self.bus = can.Bus(**options)
        self.waiting: deque[tuple[float, int, bytes]] = deque(maxlen=10000)

    def close(self) -> None:
        self.bus.shutdown()

    def listen_to(self, node_id: int, pdos: bool = True) -> None:
        """Receives only frames of this node, by the lower seven bits of their CAN-IDs; the kernel filters them. `pdos` is False
        if PDOs are not needed: a device with an event timer of 1 ms sends faster than Python reads on a slow machine."""
        self.forget()
        every = [{"can_id": node_id, "can_mask": 0x7F}]
        services = [{"can_id": function | node_id, "can_mask": 0x7FF} for function in (0x080, 0x580, 0x700)]
        self.bus.set_filters(every if pdos else services)

    def send(self, can_id: int, data: bytes = b"") -> None:
        self.bus.send(can.Message(arbitration_id=can_id, data=data, is_extended_id=False))

    def request(self, can_id: int, size: int) -> None:
        """Sends a remote frame. python-can's socketcand interface cannot send one."""
        if self.socketcand:
            self.bus._tcp_send(f"< sendrtr {can_id:X} {size} >")
        else:
            self.bus.send(can.Message(arbitration_id=can_id, dlc=size, is_remote_frame=True, is_extended_id=False))

    def receive(self, can_id: int, seconds: float) -> bytes | None:
        found = self.receive_timed(can_id, seconds)
        return found[1] if found else None

    def receive_timed(self, can_id: int, seconds: float) -> tuple[float, bytes] | None:
        """Returns the next data frame with this CAN-ID and its time, or None if none is received in this time."""
        for i, (at, found, data) in enumerate(self.waiting):
            if found == can_id:
                del self.waiting[i]
                return at, data
        end = time.monotonic() + seconds
        while True:
            message = self.bus.recv(max(0.0, end - time.monotonic()))
            if message is not None and not message.is_remote_frame and not message.is_error_frame:
                if message.arbitration_id == can_id:
                    return message.timestamp, bytes(message.data)
                self.waiting.append((message.timestamp, message.arbitration_id, bytes(message.data)))
            if time.monotonic() >= end:
                return None

    def forget(self, can_id: int | None = None) -> None:
        """Discards the frames received so far. On SocketCAN the kernel's time stamps identify them, so that this ends
        even if frames arrive as fast as they are read."""
        begin = time.time() if self.socketcan else float("inf")
        kept = deque((one for one in self.waiting if can_id is not None and one[1] != can_id), maxlen=self.waiting.maxlen)
        while (message := self.bus.recv(0)) is not None:
            later = message.timestamp > begin
            if not message.is_remote_frame and (later or can_id not in (None, message.arbitration_id)):
                kept.append((message.timestamp, message.arbitration_id, bytes(message.data)))
            if later:
                break
        self.waiting = kept
