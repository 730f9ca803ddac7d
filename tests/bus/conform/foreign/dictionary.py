"""The object dictionary of a slave: the values of its EDS, and the checks of a write that every object has (CiA 301, 7.4 and
7.2.4.3.17)."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "masters"))
from data_sheet import DataSheet, Entry  # noqa: E402

Key = tuple[int, int]  # index and sub-index

# Abort codes of CiA 301, table 22.
TOGGLE_BIT, COMMAND, BLOCK_SIZE, SEQUENCE_NUMBER, CRC = 0x05030000, 0x05040001, 0x05040002, 0x05040003, 0x05040004
UNSUPPORTED_ACCESS, WRITE_ONLY, READ_ONLY, NO_OBJECT = 0x06010000, 0x06010001, 0x06010002, 0x06020000
NOT_MAPPABLE, PDO_LENGTH, INCOMPATIBLE, LENGTH = 0x06040041, 0x06040042, 0x06040043, 0x06070010
NO_SUB_INDEX, INVALID_VALUE, TOO_HIGH, TOO_LOW = 0x06090011, 0x06090030, 0x06090031, 0x06090032
NOT_STORED, DEVICE_STATE, NO_DATA = 0x08000020, 0x08000022, 0x08000024


class Abort(Exception):
    def __init__(self, code: int) -> None:
        super().__init__(f"{code:08X}h")
        self.code = code


class Dictionary:
    def __init__(self, sheet: Path, node_id: int) -> None:
        self.sheet = DataSheet(sheet, node_id)
        self.entries = self.sheet.entries
        self.values: dict[Key, bytes] = {}
        self.load(self.defaults())

    def defaults(self) -> dict[Key, bytes]:
        return {key: entry.default or bytes(entry.size or 0) for key, entry in self.entries.items()}

    def load(self, values: dict[Key, bytes]) -> None:
        self.values.update(values)

    def has(self, index: int, sub: int = 0) -> bool:
        return (index, sub) in self.entries

    def find(self, key: Key) -> Entry:
        if key in self.entries:
            return self.entries[key]
        raise Abort(NO_SUB_INDEX if any(index == key[0] for index, _ in self.entries) else NO_OBJECT)

    def number(self, index: int, sub: int = 0) -> int:
        """Returns the value of an entry of the EDS; 0 if the EDS does not have it."""
        return int.from_bytes(self.values.get((index, sub), b""), "little")

    def set(self, index: int, sub: int, number: int) -> None:
        self.values[index, sub] = number.to_bytes(self.entries[index, sub].size, "little")

    def readable(self, key: Key) -> bytes:
        """Returns the value for a read over the bus."""
        if not self.find(key).readable:
            raise Abort(WRITE_ONLY)
        return self.values[key]

    def check_writable(self, key: Key) -> Entry:
        """Raises Abort if the entry does not exist or is read-only."""
        entry = self.find(key)
        if not entry.writable:
            raise Abort(READ_ONLY)
        return entry

    def check_write(self, key: Key, data: bytes) -> None:
        """Raises Abort for access, length and limits."""
        entry = self.check_writable(key)
        if entry.size is None:
            return
        if len(data) != entry.size:
            raise Abort(LENGTH)
        number = int.from_bytes(data, "little", signed=entry.range_of_type()[0] < 0)
        if entry.high is not None and number > entry.high:
            raise Abort(TOO_HIGH)
        if entry.low is not None and number < entry.low:
            raise Abort(TOO_LOW)
