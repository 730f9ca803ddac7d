#!/usr/bin/env python3
"""Bits, values, units, scales and error codes of the reference devices are those of their manuals.

    meaning_test.py SOURCE_DIR EDSC

meaning/NNN.tsv has them as manual NNN prints them, one per line: place in the manual, object (6041h, 2003h:01 or emcy), kind,
bits or value, words of the manual, name, and where the manual is of several devices, the device or `all`:

    field       bits (4, 0..7, or 3:12 for bit 12 in the case 3)   a name for the bits; `reserved` for reserved bits
    value       value, or bits=value                               a name for a value of the object, or of a field
    masked      mask=value                                         a name for a value of some bits together
    unit        empty, or the bits of a field                      the unit
    scale       number                                             physical = raw * scale + offset
    offset      number
    same_as     empty                                              the object whose values or fields these are
    error_code  code                                               the text of an error code

Each row is in the output of `edsc dump` for the device, and each part of it that comes from the options file is in a row, or is
a bit with the name that CiA 402 has for it: the fields of an object come from one source, so options repeat those of the profile.
An object without a sub-index is a VAR, or the first entry of an ARRAY or RECORD after sub-index 0.

meaning/NNN_tables.tsv has each table of the manual that defines bits or values: place, table, `typed` or `not typed`, and the
objects or the reason. An object of a typed table has a row in NNN.tsv.
"""

from __future__ import annotations

import csv
import json
import re
import subprocess
import sys
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from value_only import DEVICES, Key, text_of

ADDRESS = re.compile(r"([0-9A-F]{4})h(?::([0-9A-F]{2}))?")
COLUMNS = ["place", "object", "kind", "bits or value", "words", "name"]
Member = dict[str, Any]


def snake_case(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


@dataclass(frozen=True)
class Fact:
    """A part of a meaning; the object is an entry, or `emcy`."""
    object: Key | str
    kind: str
    number: str
    name: str

    def __str__(self) -> str:
        where = self.object if isinstance(self.object, str) else text_of(self.object)
        return f'{where} {self.kind} {self.number} "{self.name}"'


@dataclass(frozen=True)
class Row:
    place: str
    object: str
    kind: str
    number: str
    words: str
    name: str
    device: str = "all"


class Device:
    """The facts of a device, each with its source: options, eds or profile."""

    def __init__(self, source: Path, edsc: str, name: str) -> None:
        self.name = name
        output = subprocess.run([edsc, "dump", str(source / "eds" / f"{name}.eds"), "--node-id", "5"], check=True,
                                stdout=subprocess.PIPE, text=True, encoding="utf-8").stdout
        dump = json.loads(output)
        self.sources: dict[Fact, str] = {}
        self.entries: dict[int, list[int]] = {}
        self.units: dict[str, str] = {}  # ASCII spelling -> symbol
        for code in dump["error_codes"]:
            self.add("emcy", "error_code", f"{code['code']:04X}h", snake_case(code["text"]), code["source"])
        for item in dump["objects"]:
            self.entries[item["index"]] = [entry["sub_index"] for entry in item["entries"]]
            for entry in item["entries"]:
                if "meaning" in entry:
                    self.read((entry["index"], entry["sub_index"]), entry["meaning"])

    def add(self, where: Key | str, kind: str, number: str, name: str, source: str) -> None:
        self.sources[Fact(where, kind, number, name)] = source

    def read(self, key: Key, meaning: Member) -> None:
        self.read_quantity(key, meaning, "")
        self.read_values(key, meaning, "")
        self.read_fields(key, meaning.get("fields", []), "")
        for case in meaning.get("cases", []):
            for value in case["values"]:
                self.read_fields(key, case["fields"], f"{value}:")
        for group in meaning.get("masked", []):
            for one in group["values"]:
                self.add(key, "masked", f"{one['mask']}={one['value']}", one["name"], one["source"])
        if "same_as" in meaning:
            same = meaning["same_as"]
            self.add(key, "same_as", "", text_of((same["index"], same["sub_index"])), meaning["source"])

    def read_quantity(self, key: Key, part: Member, bits: str) -> None:
        if "quantity" not in part:
            return
        quantity = part["quantity"]
        unit = quantity["ascii_unit"] or quantity["unit"]
        self.units[quantity["unit"]] = unit
        if unit:
            self.add(key, "unit", bits, unit, quantity["source"])
        for kind in ("scale", "offset"):
            self.add(key, kind, bits, str(Fraction(quantity[kind])), quantity["source"])

    def read_values(self, key: Key, part: Member, bits: str) -> None:
        for one in part.get("values", []):
            self.add(key, "value", f"{bits}={one['value']}" if bits else str(one["value"]), one["name"], one["source"])

    def read_fields(self, key: Key, fields: list[Member], case: str) -> None:
        for field in fields:
            last = field["first_bit"] + field["bits"] - 1
            bits = case + (str(last) if field["bits"] == 1 else f"{field['first_bit']}..{last}")
            self.add(key, "field", bits, field["name"] or "reserved", field["source"])
            self.read_values(key, field, bits)
            self.read_quantity(key, field, bits)

    def key_of(self, address: str) -> Key | None:
        match = ADDRESS.fullmatch(address)
        assert match is not None, address
        index = int(match[1], 16)
        subs = self.entries.get(index, [])
        sub = int(match[2], 16) if match[2] else next((one for one in subs if one != 0 or len(subs) == 1), -1)
        return (index, sub) if sub in subs else None

    def fact_of(self, row: Row) -> Fact | None:
        """Nothing if the device does not have the object."""
        if row.kind == "error_code":
            return Fact("emcy", row.kind, row.number, snake_case(row.name))
        key = self.key_of(row.object)
        if key is None:
            return None
        left, _, number = row.number.rpartition("=")
        if row.kind == "value":
            return Fact(key, row.kind, (left + "=" if left else "") + str(int(number, 0)), row.name)
        if row.kind == "masked":
            return Fact(key, row.kind, f"{int(left, 0)}={int(number, 0)}", row.name)
        if row.kind in ("scale", "offset"):
            return Fact(key, row.kind, "", str(Fraction(row.number)))
        if row.kind == "unit":
            return Fact(key, row.kind, row.number, self.units.get(row.name, row.name))
        if row.kind == "same_as":
            other = self.key_of(row.name)
            return Fact(key, row.kind, "", text_of(other) if other else row.name)
        return Fact(key, row.kind, row.number, row.name)


def same_facts(device: Device, known: set[Fact]) -> set[Fact]:
    """The rows of an entry are also those of the entries with the same values or fields, and those of the first entry of an
    ARRAY or RECORD are those of its other entries."""
    others: dict[str, list[Key]] = {}
    for fact in device.sources:
        if fact.kind == "same_as" and not isinstance(fact.object, str):
            others.setdefault(fact.name, []).append(fact.object)
    result = set(known)
    for fact in known:
        if isinstance(fact.object, str):
            continue
        keys = [fact.object, *others.get(text_of(fact.object), [])]
        for index, first in list(keys):
            subs = device.entries[index]
            if first == next((sub for sub in subs if sub != 0), 0):
                keys += [(index, sub) for sub in subs if sub != 0]
        result |= {Fact(key, fact.kind, fact.number, fact.name) for key in keys}
    return result


def read_table(path: Path, columns: list[str]) -> list[list[str]]:
    lines = list(csv.reader(path.open(encoding="utf-8"), delimiter="\t", quoting=csv.QUOTE_NONE))
    assert lines[0][:len(columns)] == columns, f"{path.name}: expected the columns {columns}"
    for count, line in enumerate(lines, 1):
        assert len(line) == len(lines[0]), f"{path.name}:{count}: expected {len(lines[0])} cells"
    return lines[1:]


def fields_of_profile(source: Path) -> set[Fact]:
    """The fields of CiA 402 that do not depend on another object."""
    meanings = json.loads((source / "generator" / "profiles" / "cia402.json").read_text("utf-8"))["meaning"]
    return {Fact((int(address[:4], 16), 0), "field", bits, field if isinstance(field, str) else field["name"])
            for address, meaning in meanings.items() if ":" not in address
            for bits, field in meaning.get("bits", {}).items() if field is not None}


def compare_device(device: Device, rows: list[Row], manual: str, of_profile: set[Fact], problems: list[str]) -> None:
    known: set[Fact] = set()
    for row in rows:
        fact = device.fact_of(row)
        if fact is None:
            problems.append(f"{device.name}: the EDS does not have {row.object}, {row.place}")
        elif fact in device.sources:
            known.add(fact)
        else:
            found = sorted(one.name for one in device.sources if (one.object, one.kind, one.number) ==
                           (fact.object, fact.kind, fact.number))
            problems.append(f"{device.name}: {row.place} has {fact}, the device {', '.join(found) or 'nothing'}")
    plain = {("scale", "1"), ("offset", "0")}
    stated = {fact for fact, source in device.sources.items()
              if source == "options" and fact.kind != "same_as" and (fact.kind, fact.name) not in plain}
    problems += [f"{device.name}: {fact} is in the options file, not in {manual}.tsv"
                 for fact in sorted(stated - same_facts(device, known) - of_profile, key=str)]


def compare(source: Path, edsc: str, manual: str, problems: list[str]) -> int:
    folder = source / "tests" / "manuals" / "meaning"
    rows = [Row(*line) for line in read_table(folder / f"{manual}.tsv", COLUMNS)]
    of_profile = fields_of_profile(source)
    for name in DEVICES[manual]:
        own = [row for row in rows if row.device in ("all", name)]
        compare_device(Device(source, edsc, name), own, manual, of_profile, problems)
    numbers = {row.number[:4] if row.object == "emcy" else row.object[:4] for row in rows}
    for place, table, result, reason in read_table(folder / f"{manual}_tables.tsv", ["place", "table", "result"]):
        if result not in ("typed", "not typed") or not reason:
            problems.append(f"{manual}_tables.tsv: {place}, {table}: expected \"typed\" or \"not typed\", "
                            "and objects or a reason")
        for index in re.findall(r"\b([0-9A-F]{4})h", reason.split(";")[0]) if result == "typed" else []:
            if index not in numbers:
                problems.append(f"{manual}_tables.tsv: {place}, {table}: {index}h is not in {manual}.tsv")
    return len(rows)


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), sys.argv[2]
    problems: list[str] = []
    manuals = sorted(path.stem for path in (source / "tests" / "manuals" / "meaning").glob("???.tsv"))
    count = sum(compare(source, edsc, manual, problems) for manual in manuals)
    print("\n".join(problems))
    print(f"{count} rows of {len(manuals)} manuals, {len(problems)} problems")
    return 1 if problems or not manuals else 0


if __name__ == "__main__":
    sys.exit(main())
