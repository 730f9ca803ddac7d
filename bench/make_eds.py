#!/usr/bin/env python3
"""Prints a synthetic EDS of any size, to test how time and memory of edsc grow.

    make_eds.py OBJECTS [--subs N] [--access rw|const] > big.eds

OBJECTS objects from 2000h on, each a RECORD of N sub-indices (including sub-index 0), or a VAR if N is 0. They are of 64 kinds,
which differ in types and values. A generated dictionary is limited to 64 KiB for values in RAM and 65,535 rows of sub-indices:
large EDS files fit only with `const` entries, whose 16 bits are in rows that records of one kind share.
"""

from __future__ import annotations

import argparse
import random
from typing import Iterator

FIRST_INDEX = 0x2000
KINDS = 64
WORDS = ["Actual", "Target", "Maximum", "Minimum", "Motor", "Axis", "Position", "Velocity", "Torque", "Filter", "Status",
         "Control", "Input", "Output", "Temperature", "Offset"]
TYPES = {0x05: 0xFF, 0x06: 0xFFFF, 0x02: 0x7F, 0x03: 0x7FFF}


def section(name: str, **keys: object) -> Iterator[str]:
    yield f"[{name}]"
    for key, value in keys.items():
        yield f"{key}={value}"
    yield ""


def entry(name: str, title: str, data_type: int, access: str, default: int) -> Iterator[str]:
    yield from section(name, ParameterName=title, ObjectType="0x7", DataType=f"0x{data_type:04X}", AccessType=access,
                       DefaultValue=default, PDOMapping=0)


def index_list(name: str, indices: list[int]) -> Iterator[str]:
    yield from section(name, SupportedObjects=len(indices),
                       **{str(i): f"0x{index:04X}" for i, index in enumerate(indices, 1)})


def lines(objects: int, subs: int, access: str) -> Iterator[str]:
    chance = random.Random(306)
    indices = range(FIRST_INDEX, FIRST_INDEX + objects)

    def value(name: str, title: str, kind: random.Random) -> Iterator[str]:
        data_type, highest = kind.choice(list(TYPES.items()))
        yield from entry(name, title, data_type, access, kind.randint(0, highest))

    yield from section("FileInfo", FileName="big.eds", FileVersion=1, FileRevision=1, EDSVersion="4.0")
    yield from section("DeviceInfo", VendorName="edsc", VendorNumber="0x123", ProductName="Big", ProductNumber=1,
                       RevisionNumber=1)
    yield from index_list("MandatoryObjects", [0x1000, 0x1001, 0x1018])
    yield from entry("1000", "Device type", 0x07, "ro", 0)
    yield from entry("1001", "Error register", 0x05, "ro", 0)
    yield from section("1018", ParameterName="Identity object", ObjectType="0x9", SubNumber=2)
    yield from entry("1018sub0", "Highest sub-index supported", 0x05, "const", 1)
    yield from entry("1018sub1", "Vendor-ID", 0x07, "ro", 0x123)
    yield from index_list("OptionalObjects", [i for i in indices if i >= 0x6000])
    yield from index_list("ManufacturerObjects", [i for i in indices if i < 0x6000])
    for index in indices:
        kind = random.Random(index % KINDS)
        title = " ".join(chance.choices(WORDS, k=3))
        if subs == 0:
            yield from value(f"{index:04X}", title, kind)
            continue
        yield from section(f"{index:04X}", ParameterName=title, ObjectType="0x9", SubNumber=subs)
        yield from entry(f"{index:04X}sub0", "Highest sub-index supported", 0x05, "const", subs - 1)
        for sub in range(1, subs):
            yield from value(f"{index:04X}sub{sub:X}", " ".join(chance.choices(WORDS, k=2)), kind)


def make(objects: int, subs: int, access: str) -> str:
    return "\n".join(lines(objects, subs, access)) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description="Prints a synthetic EDS.")
    parser.add_argument("objects", type=int, help=f"number of objects, at most {0x10000 - FIRST_INDEX}")
    parser.add_argument("--subs", type=int, default=5, help="sub-indices of each; 0: VARs (default: %(default)s)")
    parser.add_argument("--access", choices=["rw", "const"], default="const", help="(default: %(default)s)")
    arguments = parser.parse_args()
    print(make(arguments.objects, arguments.subs, arguments.access), end="")


if __name__ == "__main__":
    main()
