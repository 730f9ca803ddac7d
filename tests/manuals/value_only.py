"""The objects of a reference device that hold a value and have no other effect: examples/nodes/NODE/value_only.tsv.

Each row is: object (2041h, 3006h:0F or 2190h:01..08), place in the manual, reason.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

DEVICES = {  # of each manual: EDS without its suffix
    "000": ("cpc-tc1",),
    "001": ("ezd-1136",),
    "002": ("cpd",),
    "003": ("can-2017c", "can-2024c", "can-2053c", "can-2057c"),
    "004": ("rk5c",),
}
OBJECT = re.compile(r"([0-9A-F]{4})h(?::([0-9A-F]{2})(?:\.\.([0-9A-F]{2}))?)?")
SECTION = re.compile(r"\[([0-9A-Fa-f]{4})(?:sub([0-9A-Fa-f]+))?\]")
Key = tuple[int, int]


@dataclass(frozen=True)
class Row:
    object: str
    place: str
    reason: str
    keys: tuple[Key, ...]


def table_of(source: Path, device: str) -> Path:
    return source / "examples" / "nodes" / device.replace("-", "_") / "value_only.tsv"


def read_rows(source: Path, device: str, problems: list[str]) -> list[Row]:
    path = table_of(source, device)
    rows = []
    for count, line in enumerate(path.read_text(encoding="utf-8").splitlines() if path.exists() else [], 1):
        cells = line.split("\t")
        match = OBJECT.fullmatch(cells[0])
        if len(cells) != 3 or not all(cells) or match is None:
            problems.append(f"{path.relative_to(source)}:{count}: expected object, place and reason")
            continue
        index, first = int(match[1], 16), int(match[2] or "0", 16)
        last = int(match[3], 16) if match[3] else first
        rows.append(Row(*cells, tuple((index, sub) for sub in range(first, last + 1))))
    return rows


def entries_of_eds(source: Path, device: str) -> dict[Key, dict[str, str]]:
    """The keys of each entry. An object with sub-indices is the entry of sub-index 0."""
    entries: dict[Key, dict[str, str]] = {}
    entry: dict[str, str] = {}
    for line in (source / "eds" / f"{device}.eds").read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            match = SECTION.fullmatch(line)
            entry = {}
            if match:
                entry = entries.setdefault((int(match[1], 16), int(match[2] or "0", 16)), {})
        elif "=" in line and not line.startswith(";"):
            key, value = line.split("=", 1)
            entry.setdefault(key, value)
    return entries


def names_in_eds(source: Path, device: str) -> dict[Key, str]:
    """The entries outside 1000h to 1FFFh, except the numbers of sub-indices, with their names."""
    entries = entries_of_eds(source, device)
    parents = {index for index, sub in entries if sub != 0}
    return {(index, sub): entry["ParameterName"] for (index, sub), entry in sorted(entries.items())
            if not 0x1000 <= index <= 0x1FFF and (sub != 0 or index not in parents)}


def text_of(key: Key) -> str:
    return f"{key[0]:04X}h:{key[1]:02X}"


def document(source: Path, device: str, problems: list[str]) -> list[str]:
    """The rows of a device for docs/developers/manuals.md."""
    names = names_in_eds(source, device)
    out = []
    for row in read_rows(source, device, problems):
        missing = [text_of(key) for key in row.keys if key not in names]
        if missing:
            problems.append(f"{table_of(source, device).relative_to(source)}: {', '.join(missing)} does not exist")
            continue
        name = names[row.keys[0]] + (f" to {names[row.keys[-1]]}" if len(row.keys) > 1 else "")
        out.append(f"| {row.object} | {name} | {row.place} | {row.reason} |")
    return out
