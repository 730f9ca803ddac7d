"""An EDS for a master, read with the standard library's configparser, without edsc's code."""

from __future__ import annotations

import configparser
import re
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

SECTION = re.compile(r"([0-9A-Fa-f]{4})(?:sub([0-9A-Fa-f]+))?")

# Data types of CiA 301: name, bytes (None: variable length), signed.
TYPES = {
    0x0001: ("BOOLEAN", 1, False), 0x0002: ("INTEGER8", 1, True), 0x0003: ("INTEGER16", 2, True),
    0x0004: ("INTEGER32", 4, True), 0x0005: ("UNSIGNED8", 1, False), 0x0006: ("UNSIGNED16", 2, False),
    0x0007: ("UNSIGNED32", 4, False), 0x0009: ("VISIBLE_STRING", None, False), 0x000F: ("DOMAIN", None, False),
    0x0015: ("INTEGER64", 8, True), 0x001B: ("UNSIGNED64", 8, False),
}
DOMAIN = 0x000F


@dataclass
class Entry:
    index: int
    sub: int
    type: int
    access: str
    default: bytes | None  # as in SDO; None: the EDS does not have one
    low: int | None
    high: int | None
    mappable: bool
    factor: Decimal  # physical units of one increment

    @property
    def name(self) -> str:
        return f"{self.index:04X}h:{self.sub:02X}"

    @property
    def size(self) -> int | None:
        return TYPES[self.type][1]

    @property
    def readable(self) -> bool:
        return self.access != "wo"

    @property
    def writable(self) -> bool:
        return self.access not in ("ro", "const")

    def range_of_type(self) -> tuple[int, int]:
        bits = 8 * self.size
        return (-(1 << bits - 1), (1 << bits - 1) - 1) if TYPES[self.type][2] else (0, (1 << bits) - 1)

    def bytes_of(self, value: int) -> bytes:
        return value.to_bytes(self.size, "little", signed=value < 0)


class DataSheet:
    def __init__(self, path: Path, node_id: int) -> None:
        file = configparser.RawConfigParser(strict=False, comment_prefixes=(";",), delimiters=("=",))
        file.read_string(path.read_text(encoding="utf-8"))
        self.node_id = node_id
        self.entries: dict[tuple[int, int], Entry] = {}
        for section in file.sections():
            if match := SECTION.fullmatch(section):
                keys = file[section]
                if "datatype" in keys:
                    entry = self.entry(int(match[1], 16), int(match[2] or "0", 16), keys)
                    self.entries[entry.index, entry.sub] = entry

    def number(self, text: str) -> int | None:
        text = text.strip().upper()
        if not text:
            return None
        offset, plain = (self.node_id, text.replace("$NODEID", "").strip("+ ")) if "$NODEID" in text else (0, text)
        return offset + (int(plain, 0) if plain else 0)

    def entry(self, index: int, sub: int, keys: configparser.SectionProxy) -> Entry:
        kind = int(keys["DataType"], 0)
        size, signed = TYPES[kind][1:]
        text = keys.get("DefaultValue", "").strip()
        default = text.encode("utf-8") if size is None else None
        if size is not None and (value := self.number(text)) is not None:
            default = (value & ((1 << 8 * size) - 1)).to_bytes(size, "little")
        limits = []
        for key in ("LowLimit", "HighLimit"):
            limit = self.number(keys.get(key, "")) if size is not None else None
            if limit is not None and signed and limit >= 1 << 8 * size - 1:
                limit -= 1 << 8 * size
            limits.append(limit)
        return Entry(index, sub, kind, keys["AccessType"].strip().lower(), default if text else None, *limits,
                     keys.get("PDOMapping", "0").strip() == "1", Decimal(keys.get("Factor", "1").strip()))

    def get(self, index: int, sub: int = 0) -> Entry | None:
        return self.entries.get((index, sub))

    def default(self, index: int, sub: int = 0, otherwise: int | None = None) -> int | None:
        entry = self.get(index, sub)
        return int.from_bytes(entry.default, "little") if entry and entry.default is not None else otherwise

    def subs(self, index: int) -> list[int]:
        return sorted(sub for found, sub in self.entries if found == index)
