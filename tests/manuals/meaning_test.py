#!/usr/bin/env python3
"""Bits, values, units, scales and error codes of the reference devices are those of their manuals.

    meaning_test.py SOURCE_DIR

meaning/NNN.tsv has them as manual NNN prints them, one per line: place in the manual, object (6041h, 2003h:01 or emcy), kind,
bits or value, words of the manual, name, and where the manual is of several devices, the device or `all`:

    field       bits (4 or 0..7)       a name for the bits; `reserved` for reserved bits
    value       value, or bits=value   a name for a value of the object, or of a field
    masked      mask=value             a name for a value of some bits together
    unit        empty                  the unit
    scale       number                 physical = raw * scale + offset
    offset      number
    error_code  code                   the text of an error code, in snake_case

Each row is compared with the options file of the device, the keys of its EDS and the profiles in generator/profiles, of which the
first one that has a property defines it. Each bit, value, scale and error code in the options file has a row, too.

meaning/NNN_tables.tsv has each table of the manual that defines bits or values: place, table, `typed` or `not typed`, and the
objects or the reason. An object of a typed table has a row in NNN.tsv.
"""

from __future__ import annotations

import csv
import json
import re
import sys
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from value_only import DEVICES, Key, entries_of_eds, text_of

ADDRESS = re.compile(r"([0-9A-F]{4})h(?:\.\.([0-9A-F]{4})h)?(?::([0-9A-F]{2}))?")
QUANTITY = ("unit", "scale", "offset")
DEFAULTS = {"scale": "1", "offset": "0"}
COLUMNS = ["place", "object", "kind", "bits or value", "words", "name"]
Meaning = dict[str, Any]


def snake_case(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


def name_of(described: Any) -> str:
    """A text is the name, an object has it as a member."""
    return "reserved" if described is None else described if isinstance(described, str) else described["name"]


def members(described: Any, member: str) -> dict[str, Any]:
    return described.get(member, {}) if isinstance(described, dict) else {}


def named_values(values: dict[str, Any]) -> dict[int, str]:
    return {int(number, 0): name_of(named) for number, named in values.items()}


def masked_values(meaning: Meaning) -> dict[tuple[int, int], str]:
    values = {}
    for group in meaning.get("masked", {}).values():
        for name, masked in group.items():
            mask, value = masked if isinstance(masked, list) else (masked["mask"], masked["value"])
            values[int(mask, 0), int(value, 0)] = name
    return values


def stated(meanings: Meaning, key: Key, is_var: bool) -> Meaning:
    """What a file says about an entry; the address of an entry takes precedence over the one of its object."""
    of_object: Meaning = {}
    of_entry: Meaning = {}
    for address, meaning in meanings.items():
        match = ADDRESS.fullmatch(address)
        if match is None or not int(match[1], 16) <= key[0] <= int(match[2] or match[1], 16):
            continue
        if match[3] is None:
            of_object = meaning if is_var or key[1] != 0 else {}
        elif int(match[3], 16) == key[1]:
            of_entry = meaning
    own = {**of_object, **of_entry}
    if "same_as" in own:
        match = ADDRESS.fullmatch(own["same_as"])
        assert match is not None
        return {**stated(meanings, (int(match[1], 16), int(match[3] or f"{key[1]:X}", 16)), is_var), **own}
    return own


class Device:
    def __init__(self, source: Path, name: str) -> None:
        self.name = name
        self.entries = entries_of_eds(source, name)
        self.parents = {index for index, sub in self.entries if sub != 0}
        self.options: Meaning = json.loads((source / "eds" / f"{name}.options.json").read_text("utf-8")).get("meaning", {})
        profile = int(self.entries[0x1000, 0]["DefaultValue"], 0) & 0xFFFF
        files = (source / "generator" / "profiles" / f"cia{number}.json" for number in (profile, 301))
        self.profiles = [json.loads(path.read_text("utf-8")) for path in files if path.exists()]

    def stated(self, meanings: Meaning, key: Key) -> Meaning:
        return stated(meanings, key, key[0] not in self.parents)

    def meaning(self, key: Key) -> Meaning:
        keys = self.entries[key]
        of_eds = {member: keys[name] for member, name in zip(QUANTITY, ("Unit", "Factor", "Offset")) if keys.get(name)}
        meaning: Meaning = {}
        for one in (self.stated(self.options, key), of_eds, *(self.stated(file["meaning"], key) for file in self.profiles)):
            has_quantity = any(member in meaning for member in QUANTITY)
            meaning |= {name: value for name, value in one.items()
                        if name not in meaning and not (name in QUANTITY and has_quantity)}
        return meaning

    def error_code(self, code: str) -> str:
        for file in (self.options, *self.profiles):
            text = file.get("emcy", {}).get(code)
            if text is not None:
                return snake_case(text if isinstance(text, str) else text["text"])
        return ""


@dataclass(frozen=True)
class Row:
    place: str
    object: str
    kind: str
    number: str
    words: str
    name: str
    device: str = "all"

    @property
    def key(self) -> Key:
        match = ADDRESS.fullmatch(self.object)
        assert match is not None, self.object
        return int(match[1], 16), int(match[3] or "0", 16)


def found_name(device: Device, row: Row) -> str | None:
    """The name that the device has in place of the row's; nothing without one."""
    if row.kind == "error_code":
        return device.error_code(row.number)
    meaning = device.meaning(row.key)
    bits, _, number = row.number.rpartition("=")
    if row.kind == "field":
        fields = meaning.get("bits", {})
        return name_of(fields[row.number]) if row.number in fields else None
    if row.kind == "value":
        described = meaning.get("bits", {}).get(bits) if bits else meaning
        return named_values(members(described, "values")).get(int(number, 0))
    if row.kind == "masked":
        return masked_values(meaning).get((int(bits, 0), int(number, 0)))
    if row.kind == "unit":
        return meaning.get("unit")
    value = str(meaning.get(row.kind, DEFAULTS[row.kind]))
    return row.name if "unit" in meaning and Fraction(value) == Fraction(row.number) else value


def facts_of_options(device: Device) -> set[tuple[Key | str, str, str]]:
    """Object, kind and number of what the options file says itself."""
    facts: set[tuple[Key | str, str, str]] = {("emcy", "error_code", code) for code in device.options.get("emcy", {})}
    for key in device.entries:
        meaning = device.stated(device.options, key)
        facts |= {(key, kind, "") for kind in ("unit", "offset") if kind in meaning}
        facts |= {(key, "value", str(number)) for number in named_values(meaning.get("values", {}))}
        facts |= {(key, "masked", f"{mask}={value}") for mask, value in masked_values(meaning)}
        for bits, described in meaning.get("bits", {}).items():
            facts.add((key, "field", bits))
            facts |= {(key, "value", f"{bits}={number}") for number in named_values(members(described, "values"))}
    return facts


def fact_of(row: Row) -> tuple[Key | str, str, str]:
    if row.kind == "error_code":
        return "emcy", row.kind, row.number
    left, _, number = row.number.rpartition("=")
    if row.kind == "value":
        return row.key, row.kind, (left + "=" if left else "") + str(int(number, 0))
    if row.kind == "masked":
        return row.key, row.kind, f"{int(left, 0)}={int(number, 0)}"
    return row.key, row.kind, row.number if row.kind == "field" else ""


def read_table(path: Path, columns: list[str]) -> list[list[str]]:
    lines = list(csv.reader(path.open(encoding="utf-8"), delimiter="\t", quoting=csv.QUOTE_NONE))
    assert lines[0][:len(columns)] == columns, f"{path.name}: expected the columns {columns}"
    for count, line in enumerate(lines, 1):
        assert len(line) == len(lines[0]), f"{path.name}:{count}: expected {len(lines[0])} cells"
    return lines[1:]


def compare(source: Path, manual: str, problems: list[str]) -> int:
    folder = source / "tests" / "manuals" / "meaning"
    rows = [Row(*line) for line in read_table(folder / f"{manual}.tsv", COLUMNS)]
    for name in DEVICES[manual]:
        device = Device(source, name)
        own = [row for row in rows if row.device in ("all", name)]
        for row in own:
            if row.object != "emcy" and row.key not in device.entries:
                problems.append(f"{name}: the EDS does not have {row.object}, {row.place}")
                continue
            found = found_name(device, row)
            if found != row.name:
                problems.append(f"{name}: {row.object} {row.kind} {row.number}: {row.place} has \"{row.name}\", "
                                f"the device \"{found}\"")
        for object_, kind, number in sorted(facts_of_options(device) - {fact_of(row) for row in own}, key=str):
            where = object_ if isinstance(object_, str) else text_of(object_)
            problems.append(f"{name}: {where} {kind} {number} is in the options file, not in {manual}.tsv")
    indices = {row.object[:4] for row in rows}
    for place, table, result, reason in read_table(folder / f"{manual}_tables.tsv", ["place", "table", "result"]):
        if result not in ("typed", "not typed") or not reason:
            problems.append(f"{manual}_tables.tsv: {place}, {table}: expected \"typed\" or \"not typed\", "
                            "and objects or a reason")
        for index in re.findall(r"\b([0-9A-F]{4})h", reason.split(";")[0]) if result == "typed" else []:
            if index not in indices:
                problems.append(f"{manual}_tables.tsv: {place}, {table}: {index}h is not in {manual}.tsv")
    return len(rows)


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    problems: list[str] = []
    manuals = sorted(path.stem for path in (source / "tests" / "manuals" / "meaning").glob("???.tsv"))
    count = sum(compare(source, manual, problems) for manual in manuals)
    print("\n".join(problems))
    print(f"{count} rows of {len(manuals)} manuals, {len(problems)} problems")
    return 1 if problems or not manuals else 0


if __name__ == "__main__":
    sys.exit(main())
