"""One RPDO and one TPDO with dynamic mapping (CiA 301, 7.5.2.35 to 7.5.2.38)."""

from __future__ import annotations

from .dictionary import (DEVICE_STATE, INVALID_VALUE, NO_OBJECT, NOT_MAPPABLE, PDO_LENGTH, UNSUPPORTED_ACCESS, Abort,
                         Dictionary, Key)
from .frames import Frame

RPDO, TPDO = 0x1400, 0x1800
MAPPING = 0x200  # from the communication parameter to the mapping parameter
COB_ID, TYPE, INHIBIT_TIME, EVENT_TIMER = 1, 2, 3, 5
INVALID, NO_RTR, EXTENDED, CAN_ID = 1 << 31, 1 << 30, 1 << 29, 0x1FFFFFFF  # of a COB-ID
ON_REQUEST = 253
DUMMIES = {5: 1, 6: 2, 7: 4}  # bytes of the data types that [DummyUsage] allows
RESTRICTED = ((0x000, 0x07F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x7FF))


def check_can_id(cob_id: int) -> None:
    """Refuses the restricted CAN-IDs of CiA 301, 7.3.5, and those with 29 bits."""
    if cob_id & EXTENDED or any(first <= cob_id & CAN_ID <= last for first, last in RESTRICTED):
        raise Abort(INVALID_VALUE)


def check_cob_id(before: int, after: int) -> None:
    """The CAN-ID of a PDO or of EMCY changes only while it is not valid."""
    if is_invalid(after):
        return
    check_can_id(after)
    if not is_invalid(before) and (before ^ after) & CAN_ID:
        raise Abort(INVALID_VALUE)


def is_invalid(cob_id: int) -> bool:
    return bool(cob_id & INVALID)


class Pdo:
    def __init__(self, dictionary: Dictionary, index: int) -> None:
        self.dictionary, self.index = dictionary, index

    def parameter(self, sub: int) -> int:
        return self.dictionary.number(self.index, sub)

    @property
    def can_id(self) -> int:
        return self.parameter(COB_ID) & 0x7FF

    @property
    def valid(self) -> bool:
        return not is_invalid(self.parameter(COB_ID))

    def mapped(self) -> list[tuple[Key, int]]:
        """Returns the mapped objects with their bytes."""
        index = self.index + MAPPING
        return [mapped_object(self.dictionary.number(index, sub)) for sub in range(1, self.dictionary.number(index, 0) + 1)]

    def size(self) -> int:
        return sum(size for _, size in self.mapped())

    def check_write(self, key: Key, value: int) -> None:
        """Refuses a value of the communication or mapping parameter."""
        index, sub = key
        if index == self.index + MAPPING:
            self.check_count(value) if sub == 0 else self.check_mapped(value)
        elif sub == COB_ID:
            check_cob_id(self.parameter(COB_ID), value)
        elif sub == TYPE and 240 < value < (ON_REQUEST if self.index == TPDO else 254):
            raise Abort(INVALID_VALUE)
        elif sub == INHIBIT_TIME and self.valid:
            raise Abort(DEVICE_STATE)

    def check_mapped(self, value: int) -> None:
        if self.valid or self.dictionary.number(self.index + MAPPING, 0) != 0:
            raise Abort(UNSUPPORTED_ACCESS)
        if value == 0:
            return
        key, size = mapped_object(value)
        if key[0] in DUMMIES and self.index == RPDO:
            if size != DUMMIES[key[0]]:
                raise Abort(NOT_MAPPABLE)
            return
        entry = self.dictionary.entries.get(key)
        if entry is None:
            raise Abort(NO_OBJECT)
        direction = ("rw", "rww", "wo") if self.index == RPDO else ("rw", "rwr", "ro", "const")
        if not entry.mappable or entry.access not in direction or entry.size != size or value & 7:
            raise Abort(NOT_MAPPABLE)

    def check_count(self, count: int) -> None:
        index = self.index + MAPPING
        if self.valid:
            raise Abort(UNSUPPORTED_ACCESS)
        if not all(self.dictionary.has(index, sub) for sub in range(count + 1)):
            raise Abort(PDO_LENGTH)
        values = [self.dictionary.number(index, sub) for sub in range(1, count + 1)]
        if 0 in values:
            raise Abort(NO_OBJECT)
        if sum(mapped_object(value)[1] for value in values) > 8:
            raise Abort(PDO_LENGTH)


class Rpdo(Pdo):
    """`waiting`: the data of a synchronous RPDO until the next SYNC."""

    def __init__(self, dictionary: Dictionary) -> None:
        super().__init__(dictionary, RPDO)
        self.waiting: bytes | None = None

    def receive(self, data: bytes) -> bool:
        """Returns False if the data are too short."""
        if len(data) < self.size():
            return False
        self.waiting = data
        if self.parameter(TYPE) > 240:
            self.on_sync()
        return True

    def on_sync(self) -> None:
        if self.waiting is None:
            return
        data, self.waiting = self.waiting, None
        for key, size in self.mapped():
            if key in self.dictionary.entries:
                self.dictionary.values[key] = data[:size]
            data = data[size:]


class Tpdo(Pdo):
    """Event-driven with inhibit time and event timer, at each n-th SYNC, at the SYNC after an event, and on remote frames."""

    def __init__(self, dictionary: Dictionary) -> None:
        super().__init__(dictionary, TPDO)
        self.stop()

    def stop(self) -> None:
        """Outside Operational, and after a change of a parameter."""
        self.sent: bytes | None = None    # data of the last frame
        self.sent_at = float("-inf")
        self.timer_at: float | None = None
        self.syncs = 0

    def start(self, now: float, is_event: bool = False) -> None:
        """Enters Operational, which may be an event."""
        self.stop()
        self.sent = None if is_event else self.data()
        self.timer_at = now + self.timer() if self.timer() else None

    def timer(self) -> float:
        return self.parameter(EVENT_TIMER) / 1000 if self.parameter(TYPE) >= 254 else 0.0

    def data(self) -> bytes:
        return b"".join(self.dictionary.values[key] for key, _ in self.mapped())

    def frame(self, now: float) -> Frame:
        self.sent, self.sent_at = self.data(), now
        if self.timer_at is not None:
            self.timer_at = now + self.timer() if now - self.timer_at > self.timer() else self.timer_at + self.timer()
        return Frame(self.can_id, self.sent)

    def poll(self, now: float) -> list[Frame]:
        """Returns the frame of an event or of the event timer. Call it in Operational."""
        if not self.valid or self.parameter(TYPE) < 254 or not self.mapped():
            return []
        due = self.timer_at is not None and now >= self.timer_at
        event = self.data() != self.sent
        if not (due or event) or now < self.free_at():
            return []
        if event and self.timer_at is not None and not due:
            self.timer_at = now  # the timer restarts with each frame
        return [self.frame(now)]

    def free_at(self) -> float:
        return self.sent_at + self.parameter(INHIBIT_TIME) / 10000

    def deadlines(self) -> list[float]:
        if not self.valid or self.parameter(TYPE) < 254:
            return []
        times = [self.timer_at] if self.timer_at is not None else []
        return [*times, self.free_at()] if self.data() != self.sent else times

    def on_sync(self, now: float) -> list[Frame]:
        kind = self.parameter(TYPE)
        if not self.valid or kind > 240 or not self.mapped():
            return []
        self.syncs += 1
        if kind == 0:
            return [self.frame(now)] if self.data() != self.sent else []
        return [self.frame(now)] if self.syncs % kind == 0 else []

    def on_request(self, now: float) -> list[Frame]:
        allowed = self.valid and not self.parameter(COB_ID) & NO_RTR and self.mapped()
        return [self.frame(now)] if allowed and self.parameter(TYPE) >= ON_REQUEST else []


def mapped_object(value: int) -> tuple[Key, int]:
    return (value >> 16, value >> 8 & 0xFF), (value & 0xFF) // 8
