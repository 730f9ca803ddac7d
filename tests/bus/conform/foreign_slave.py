#!/usr/bin/env python3
"""A CANopen slave without edsc's code, for foreign_slave.eds, on a bus of `edsc bus`. It complies with CiA 301, except for the
given gaps.

    foreign_slave.py ADDRESS NODE_ID [GAP]...
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "masters"))
from foreign_slaves_test import Bus  # noqa: E402
from slaves import NO_OBJECT, READ_ONLY, READ_ONLY_ENTRIES, TOGGLE, Slave, mux  # noqa: E402

NO_SUB_INDEX, LENGTH = 0x06090011, 0x06070010
RESET_COMMUNICATION = 130
SIZES = {(0x1000, 0): 4, (0x1017, 0): 2, (0x2000, 0): 2}
GAPS = ("abort-code", "boot-up", "heartbeat", "toggle-bit", "writable", "length")


class ForeignSlave(Slave):
    def __init__(self, node_id: int, gaps: set[str]) -> None:
        self.gaps = gaps
        super().__init__(node_id)

    def reset(self) -> None:
        super().reset()
        self.entries[(0x1000, 0)] = bytes(4)
        self.entries[(0x1018, 0)] = bytes([2])
        self.entries[(0x2001, 0)] = b"a longer text"

    def command(self, command: int) -> None:
        super().command(command)
        if command == RESET_COMMUNICATION and "boot-up" in self.gaps:
            self.outbox.pop()

    def heartbeat(self) -> float:
        return super().heartbeat() * (1.5 if "heartbeat" in self.gaps else 1.0)

    def due(self, now: float) -> list[tuple[int, bytes]]:
        expected = self.next_beat
        frames = super().due(now)
        if expected is not None and self.next_beat not in (None, expected):
            self.next_beat = expected + self.heartbeat()  # a late one does not delay those after it
        return frames

    def wait(self, now: float) -> float:
        """Returns the seconds until it must be served."""
        times = [entry[0] for entry in self.outbox[:1]] + ([self.next_beat] if self.next_beat is not None else [])
        return max(0.0, min([1.0, *(at - now for at in times)]))

    # ---- SDO server ----

    def missing(self, entry: tuple[int, int]) -> bool:
        """Returns whether the entry does not exist, after sending an abort."""
        if entry in self.entries:
            return False
        has_object = any(index == entry[0] for index, _ in self.entries)
        self.abort(entry, NO_SUB_INDEX if has_object and "abort-code" not in self.gaps else NO_OBJECT)
        return True

    def upload(self, entry: tuple[int, int]) -> None:
        if not self.missing(entry):
            super().upload(entry)

    def download(self, entry: tuple[int, int], data: bytes) -> None:
        if self.missing(entry):
            return
        writable = "writable" in self.gaps and entry == (0x1000, 0)
        if (entry in READ_ONLY_ENTRIES or entry in ((0x1001, 0), (0x1018, 0))) and not writable:
            self.abort(entry, READ_ONLY)
        elif data[0] & 3 == 3 and not self.fits(entry, 4 - (data[0] >> 2 & 3)):
            self.abort(entry, LENGTH)
        elif writable:
            self.store(entry, data[4:8])
            self.answer(bytes([0x60]) + mux(entry))
        else:
            super().download(entry, data)

    def fits(self, entry: tuple[int, int], size: int) -> bool:
        return "length" in self.gaps or size == SIZES.get(entry, size)

    def segment(self, data: bytes) -> None:
        kind, entry, value, toggle = self.transfer
        if "toggle-bit" in self.gaps:
            data = bytes([data[0] & ~0x10 | toggle << 4]) + data[1:]
        elif data[0] >> 4 & 1 != toggle:
            self.abort(entry, TOGGLE)
            return
        total = len(value) + 7 - (data[0] >> 1 & 7)
        if kind == "down" and data[0] & 1 and not self.fits(entry, total):
            self.abort(entry, LENGTH)
            return
        super().segment(data)


def main() -> None:
    address, node_id, *gaps = sys.argv[1:]
    assert set(gaps) <= set(GAPS), f"gaps are {', '.join(GAPS)}"
    bus = Bus(address)
    slave = ForeignSlave(int(node_id), set(gaps))
    print("started", flush=True)
    while True:
        for can_id, data in slave.due(time.monotonic()):
            bus.send(can_id, data)
        for can_id, data in bus.receive(slave.wait(time.monotonic())):
            slave.take(can_id, data, time.monotonic())


if __name__ == "__main__":
    main()
