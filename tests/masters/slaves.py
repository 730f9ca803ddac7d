"""CANopen slaves without edsc's code, each with its own habits; they receive and return frames. They support expedited and
segmented SDO, NMT, boot-up and heartbeat only: no block transfer, no guarding, no PDO."""

from __future__ import annotations

import heapq
import itertools
from dataclasses import dataclass, field

BOOT_UP, STOPPED, OPERATIONAL, PRE_OPERATIONAL = 0, 4, 5, 127
NO_OBJECT, READ_ONLY, BAD_COMMAND, TOGGLE = 0x06020000, 0x06010002, 0x05040001, 0x05030000
READ_ONLY_ENTRIES = {(0x1000, 0), (0x1018, 1), (0x1018, 2)}


@dataclass
class Habits:
    """Differences from a good slave."""
    product: int = 0x10001
    has_heartbeat: bool = True
    silent: bool = False          # no answer to any SDO request
    delay: float = 0.0            # of each SDO answer, in seconds
    delayed_answers: int = 10**9  # number of delayed answers; the others are immediate
    boot_ups: int = 1             # messages after each reset
    resets_at_write: bool = False  # once: it resets when 2000h is written, without an answer
    dies_after: float | None = None  # seconds after its first start; it works again after a reset


@dataclass
class Slave:
    node_id: int
    habits: Habits = field(default_factory=Habits)
    now: float = 0.0

    def __post_init__(self) -> None:
        self.outbox: list[tuple[float, int, int, bytes]] = []
        self.order = itertools.count()
        self.state = BOOT_UP
        self.dead = False
        self.dies_at: float | None = None
        self.reset()

    def reset(self) -> None:
        self.entries = {
            (0x1000, 0): (0x000F0191).to_bytes(4, "little"),
            (0x1001, 0): b"\0",
            (0x1018, 1): (0x1234).to_bytes(4, "little"),
            (0x1018, 2): self.habits.product.to_bytes(4, "little"),
            (0x2000, 0): bytes(2),
            (0x2001, 0): b"",
        }
        if self.habits.has_heartbeat:
            self.entries[(0x1017, 0)] = bytes(2)
        self.transfer: tuple[str, tuple[int, int], bytes, int] | None = None  # kind, entry, bytes, toggle
        self.next_beat: float | None = None
        self.dead = False
        for _ in range(self.habits.boot_ups):
            self.put(0x700 + self.node_id, bytes([BOOT_UP]))
        self.state = PRE_OPERATIONAL

    def put(self, can_id: int, data: bytes, delay: float = 0.0) -> None:
        heapq.heappush(self.outbox, (self.now + delay, next(self.order), can_id, data))

    def due(self, now: float) -> list[tuple[int, bytes]]:
        """Returns what it sends until now."""
        self.now = now
        if self.dies_at is not None and now >= self.dies_at:
            self.dead, self.dies_at, self.outbox = True, None, []
        if self.next_beat is not None and now >= self.next_beat and not self.dead:
            self.put(0x700 + self.node_id, bytes([self.state]))
            self.next_beat = now + self.heartbeat()
        frames = []
        while self.outbox and self.outbox[0][0] <= now:
            frames.append(heapq.heappop(self.outbox)[2:])
        return frames

    def heartbeat(self) -> float:
        return int.from_bytes(self.entries[(0x1017, 0)], "little") / 1000

    def take(self, can_id: int, data: bytes, now: float) -> None:
        self.now = now
        if can_id == 0 and len(data) == 2 and data[1] in (0, self.node_id):
            self.command(data[0])
        elif can_id == 0x600 + self.node_id and len(data) == 8 and not self.dead and self.state != STOPPED:
            self.request(data)

    def command(self, command: int) -> None:
        if command in (129, 130):
            self.reset()
        elif not self.dead:
            self.state = {1: OPERATIONAL, 2: STOPPED, 128: PRE_OPERATIONAL}.get(command, self.state)
            if command == 1 and self.habits.dies_after is not None:
                self.dies_at = self.now + self.habits.dies_after
                self.habits.dies_after = None

    # ---- SDO server ----

    def answer(self, data: bytes) -> None:
        if self.habits.silent:
            return
        late = self.habits.delayed_answers > 0
        self.habits.delayed_answers -= 1
        self.put(0x580 + self.node_id, data.ljust(8, b"\0"), self.habits.delay if late else 0.0)

    def abort(self, entry: tuple[int, int], code: int) -> None:
        self.transfer = None
        self.answer(bytes([0x80]) + mux(entry) + code.to_bytes(4, "little"))

    def request(self, data: bytes) -> None:
        entry = (int.from_bytes(data[1:3], "little"), data[3])
        kind = data[0] >> 5
        if kind == 4:  # abort
            self.transfer = None
        elif kind == 2:
            self.upload(entry)
        elif kind == 1:
            self.download(entry, data)
        elif kind in (0, 3) and self.transfer and self.transfer[0] == ("down" if kind == 0 else "up"):
            self.segment(data)
        else:
            self.abort(entry if kind in (5, 6) else (0, 0), BAD_COMMAND)

    def upload(self, entry: tuple[int, int]) -> None:
        self.transfer = None
        value = self.entries.get(entry)
        if value is None:
            self.abort(entry, NO_OBJECT)
        elif 1 <= len(value) <= 4:
            self.answer(bytes([0x43 | (4 - len(value)) << 2]) + mux(entry) + value)
        else:
            self.transfer = ("up", entry, value, 0)
            self.answer(bytes([0x41]) + mux(entry) + len(value).to_bytes(4, "little"))

    def download(self, entry: tuple[int, int], data: bytes) -> None:
        self.transfer = None
        if entry not in self.entries:
            self.abort(entry, NO_OBJECT)
        elif entry in READ_ONLY_ENTRIES:
            self.abort(entry, READ_ONLY)
        elif entry == (0x2000, 0) and self.habits.resets_at_write:
            self.habits.resets_at_write = False
            self.reset()
        elif data[0] & 2:
            self.store(entry, data[4:8 - ((data[0] >> 2) & 3)])
            self.answer(bytes([0x60]) + mux(entry))
        else:
            self.transfer = ("down", entry, b"", 0)
            self.answer(bytes([0x60]) + mux(entry))

    def segment(self, data: bytes) -> None:
        kind, entry, value, toggle = self.transfer
        if (data[0] >> 4) & 1 != toggle:
            self.abort(entry, TOGGLE)
            return
        if kind == "up":
            piece, rest = value[:7], value[7:]
            self.transfer = ("up", entry, rest, toggle ^ 1) if rest else None
            self.answer(bytes([toggle << 4 | (7 - len(piece)) << 1 | (not rest)]) + piece)
            return
        value += data[1:8 - ((data[0] >> 1) & 7)]
        last = data[0] & 1
        self.transfer = None if last else ("down", entry, value, toggle ^ 1)
        if last:
            self.store(entry, value)
        self.answer(bytes([0x20 | toggle << 4]))

    def store(self, entry: tuple[int, int], value: bytes) -> None:
        self.entries[entry] = value
        if entry == (0x1017, 0):
            self.next_beat = self.now if self.heartbeat() else None


def mux(entry: tuple[int, int]) -> bytes:
    return entry[0].to_bytes(2, "little") + bytes([entry[1]])
