#!/usr/bin/env python3
"""Makes the large EDS files of the measurements from ref.eds: regular objects of the manufacturer are added to it.

    sheets.py FOLDER     writes all of them; each program of this folder makes those that it needs

The same bytes at each call, so that figures of other programs for these files stay comparable.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Callable, Iterable, Iterator, Sequence

HERE = Path(__file__).resolve().parent
FIELD_TYPES = (0x06, 0x05, 0x04, 0x07)  # types of fields, in turn

REF_PDOS = 4  # of each direction in ref.eds
LAST_COMMUNICATION = 5  # highest sub-index of a communication parameter
RECORD_FIELDS = 254
PDO_INDICES = {"RPDO": (0x1400, 0x1600, 0x3000, 0x10000), "TPDO": (0x1800, 0x1A00, 0x3100, 0x20000)}

Section = tuple[str, dict[str, str]]


def entry(name: str, title: str, data_type: int, default: str, access: str = "rw") -> Section:
    return name, {"ParameterName": title, "ObjectType": "0x7", "DataType": f"0x{data_type:04X}", "AccessType": access,
                  "DefaultValue": default, "PDOMapping": "1" if access == "rw" and data_type != 0x0F else "0"}


def record(index: int, title: str, highest: str, field: str, fields: int,
           types: Sequence[int] = FIELD_TYPES) -> Iterator[Section]:
    name = f"{index:04X}"
    yield name, {"ParameterName": title, "ObjectType": "0x9", "SubNumber": f"0x{fields + 1:X}"}
    yield entry(f"{name}sub0", highest, 0x05, f"0x{fields:X}", "ro")
    for sub in range(1, fields + 1):
        yield entry(f"{name}sub{sub:X}", f"{field}{sub}", types[(sub - 1) % len(types)], f"0x{sub:X}")


def domains() -> Iterator[Section]:
    yield entry("2F00", "Blob_1k", 0x0F, "")
    yield entry("2F01", "Blob_8k", 0x0F, "")


def variables(count: int) -> Iterator[Section]:
    yield from domains()
    for i in range(count):
        yield entry(f"{0x3000 + i:04X}", f"synth_{i}", 0x07, f"0x{i:X}")


def records(count: int, types: Sequence[int] = FIELD_TYPES) -> Iterator[Section]:
    yield from domains()
    for i in range(count):
        yield from record(0x3000 + i, f"synthrec_{i}", "n", "s", 9, types)


def mixture(count: int) -> Iterator[Section]:
    """Three variables and a record in turn."""
    for i in range(count):
        if i % 4 == 3:
            yield from record(0x2400 + i, f"Synthetic record {i}", "Highest sub-index", "Field ", 4)
        else:
            yield entry(f"{0x2400 + i:04X}", f"Synthetic variable {i}", (0x07, 0x03, 0x05)[i % 3], f"0x{i % 100:X}")


def parameter(index: int, title: str, highest: int, values: Iterable[tuple[int, str, int, str]]) -> Iterator[Section]:
    """A record of PDO parameters; `values` are sub-index, title, data type and default value."""
    entries = list(values)
    name = f"{index:04X}"
    yield name, {"ParameterName": title, "ObjectType": "0x9", "SubNumber": f"0x{len(entries) + 1:X}"}
    for sub, field, data_type, default in [(0, "n", 0x05, f"0x{highest:X}"), *entries]:
        section, keys = entry(f"{name}sub{sub:X}", field, data_type, default,
                              "ro" if sub == 0 and highest == LAST_COMMUNICATION else "rw")
        yield section, {**keys, "PDOMapping": "0"}


def pdos(count: int) -> Iterator[Section]:
    """All PDOs up to `count` of both directions, in addition to those of ref.eds: 29-bit CAN-IDs, and eight mapped bytes
    of their own each."""
    for direction, (communication, mapping, first_object, can_ids) in PDO_INDICES.items():
        for number in range(REF_PDOS, count):
            record_number, position = divmod(number * 8, RECORD_FIELDS - RECORD_FIELDS % 8)
            mapped = [(sub, f"m{sub}", 0x07, f"0x{first_object + record_number:04X}{position + sub:02X}08")
                      for sub in range(1, 9)]
            yield from parameter(communication + number, f"{direction}_comm_{number + 1}", LAST_COMMUNICATION, [
                (1, "cobid", 0x07, f"0x{0x2000_0000 + can_ids + number:X}"),
                (2, "type", 0x05, "0xFE"), (5, "event_timer", 0x06, "0x0")])
            yield from parameter(mapping + number, f"{direction}_map_{number + 1}", len(mapped), mapped)
        for i in range((count * 8 - 1) // (RECORD_FIELDS - RECORD_FIELDS % 8) + 1):
            yield from record(first_object + i, f"{direction}_values_{i}", "n", "s", RECORD_FIELDS, (0x05,))


SHEETS: dict[str, Callable[[], Iterable[Section]]] = {
    "ref": lambda: (),
    "bench100": lambda: variables(22),
    "bench1000": lambda: variables(922),
    "rec100x9": lambda: records(100),
    "eds1000": lambda: mixture(924),
    "eds5000": lambda: mixture(4924),
    "rec6500x9": lambda: records(6500, (0x05,)),  # 65,000 entries, whose values take 64 KiB
    "pdos512": lambda: pdos(512),  # of each direction
}


def read_sections(text: str) -> list[Section]:
    blocks = [block.split("\n") for block in text.strip().split("\n\n")]
    return [(title[1:-1], dict(line.split("=", 1) for line in keys)) for title, *keys in blocks]


def object_lists(sections: list[Section], added: list[Section]) -> None:
    """Adds objects to the lists of optional objects and of objects of the manufacturer, and PDOs to their numbers."""
    indices = [int(title, 16) for title, _ in added if "sub" not in title]
    for name, keys in sections:
        if name in ("ManufacturerObjects", "OptionalObjects"):
            listed = [int(value, 16) for key, value in keys.items() if key != "SupportedObjects"]
            listed = sorted(listed + [i for i in indices if (i < 0x2000) == (name == "OptionalObjects")])
            keys.clear()
            keys["SupportedObjects"] = str(len(listed))
            keys.update({str(i): f"0x{index:04X}" for i, index in enumerate(listed, 1)})
        if name == "DeviceInfo":
            for key, first in (("NrOfRXPDO", 0x1400), ("NrOfTXPDO", 0x1800)):
                keys[key] = str(int(keys[key]) + sum(first <= index < first + 512 for index in indices))


def make(name: str) -> str:
    """Returns the text of an EDS of `SHEETS`."""
    sections = read_sections((HERE / "ref.eds").read_text())
    sections[0][1]["FileName"] = f"{name}.eds"
    added = list(SHEETS[name]())
    object_lists(sections, added)
    first_object = next(i for i, (title, _) in enumerate(sections) if title == "1000")
    objects = sections[first_object:] + added
    objects.sort(key=lambda section: int(section[0][:4], 16))  # stable: sub-indices stay behind their object
    lines = []
    for title, keys in sections[:first_object] + objects:
        lines += [f"[{title}]", *(f"{key}={value}" for key, value in keys.items()), ""]
    return "\n".join(lines)


def write(name: str, folder: Path) -> Path:
    """Writes an EDS of `SHEETS` into a folder and returns its path."""
    path = folder / f"{name}.eds"
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(make(name))
    return path


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for sheet in SHEETS:
        print(write(sheet, Path(sys.argv[1])))
