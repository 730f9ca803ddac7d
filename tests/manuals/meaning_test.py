#!/usr/bin/env python3
"""The meaning of each reference device is that of its manual: bits, names of values, units, scales and error codes.

    meaning_test.py SOURCE_DIR

meaning/NNN.tsv has the tables of manual NNN: place, object (`6041h` or `2003h:01`), kind, bits or value, words, name and, if the
manual is of several devices, device. Kinds and their fourth column:

    field       4, 4..7, or 3:12 for bit 12 while the object on which it depends is 3; the name `reserved` is a reserved bit
    value       3, or 4..7=3 for the value 3 of a field
    masked      0x4F=0x08: mask and value
    unit        empty, or the bits of a field; the name is the unit
    scale, offset   the number
    same_as     empty; the name is the object that has the same values or fields
    error_code  2310h, of the object `emcy`; the words of the text are the name, joined by `_`

Each row is in the meaning of the device, which comes from the options, the EDS and the profiles, in this order. What the options
state is in a row, or equal to the profile. meaning/NNN_tables.tsv lists the tables of the manual: typed, or the reason why not.
"""

from __future__ import annotations

import json
import re
import sys
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from value_only import DEVICES, entries_of_eds

Facts = set[tuple[str, str, str, str]]  # object, kind, bits or value, name
PROPERTIES = ("unit", "scale", "offset", "values", "bits", "masked", "cases", "same_as")
ADDRESS = re.compile(r"([0-9A-F]{4})h(?:\.\.([0-9A-F]{4})h)?(?::([0-9A-F]{2}))?")


@dataclass
class Row:
    line: int
    place: str
    object: str
    kind: str
    bits: str
    words: str
    name: str
    device: str = "all"

    def fact(self) -> tuple[str, str, str, str]:
        if self.kind in ("scale", "offset"):
            return self.object, self.kind, "", str(Fraction(self.name))
        return self.object, self.kind, self.bits, self.name


def read_rows(path: Path, problems: list[str]) -> list[Row]:
    rows = []
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines()[1:], 2):
        cells = text.split("\t")
        if len(cells) not in (6, 7) or not all(cells[:3] + cells[4:]):
            problems.append(f"{path.name}:{line}: expected 6 or 7 columns, of which only the fourth may be empty")
            continue
        rows.append(Row(line, *cells))
    return rows


def words_of(text: str) -> set[str]:
    return set(re.split(r"[^a-z0-9]+", text.lower()))


def number(text: str) -> str:
    return str(int(text, 0))


def name_of(value: Any) -> str:
    return "reserved" if value is None else value if isinstance(value, str) else value["name"]


def facts_of(item: str, meaning: dict[str, Any]) -> Facts:
    """The meaning of one object as rows."""
    facts: Facts = set()

    def add_fields(bits: dict[str, Any], case: str = "") -> None:
        for place, field in bits.items():
            facts.add((item, "field", case + place, name_of(field)))
            if isinstance(field, dict):
                for value, name in field.get("values", {}).items():
                    facts.add((item, "value", f"{case}{place}={number(value)}", name_of(name)))
                if "unit" in field:
                    facts.add((item, "unit", case + place, field["unit"]))

    if "unit" in meaning:
        facts.add((item, "unit", "", meaning["unit"]))
        facts.add((item, "scale", "", str(Fraction(str(meaning.get("scale", 1))))))
        if Fraction(str(meaning.get("offset", 0))) != 0:
            facts.add((item, "offset", "", str(Fraction(str(meaning["offset"])))))
    for value, name in meaning.get("values", {}).items():
        facts.add((item, "value", number(value), name_of(name)))
    add_fields(meaning.get("bits", {}))
    for values in meaning.get("masked", {}).values():
        for name, masked in values.items():
            mask, value = masked if isinstance(masked, list) else (masked["mask"], masked["value"])
            facts.add((item, "masked", f"{mask}={value}", name))
    for numbers, case in meaning.get("cases", {}).items():
        for one in numbers.split(","):
            add_fields(case["bits"], f"{one.strip()}:")
    if "same_as" in meaning:
        facts.add((item, "same_as", "", meaning["same_as"]))
    return facts


def applies(address: str, index: int, sub_index: int) -> bool:
    match = ADDRESS.fullmatch(address)
    if match is None:
        return False
    first = int(match[1], 16)
    return first <= index <= int(match[2] or match[1], 16) and (match[3] is None or int(match[3], 16) == sub_index)


def stated(source: dict[str, Any], index: int, sub_index: int) -> dict[str, Any]:
    """What one source states about an entry; the address with a sub-index is preferred."""
    result: dict[str, Any] = {}
    for address in sorted(source, key=len):
        if applies(address, index, sub_index):
            result.update({name: value for name, value in source[address].items() if name in PROPERTIES})
    return result


class Device:
    def __init__(self, source: Path, name: str) -> None:
        self.name = name
        self.entries = entries_of_eds(source, name)
        self.options = json.loads((source / "eds" / f"{name}.options.json").read_text(encoding="utf-8")).get("meaning", {})
        profile = int(self.entries[0x1000, 0]["DefaultValue"], 0) & 0xFFFF
        self.profiles = [json.loads(path.read_text(encoding="utf-8")) for number in (profile, 301)
                         if (path := source / "generator" / "profiles" / f"cia{number}.json").exists()]

    def first_entry(self, item: str) -> tuple[int, int] | None:
        """The entry `2003h:01`, or of an object without a sub-index its VAR or its first element."""
        match = ADDRESS.fullmatch(item)
        if match is None:
            return None
        index = int(match[1], 16)
        subs = [int(match[3], 16)] if match[3] else [0, 1] if (index, 1) not in self.entries else [1]
        return next(((index, sub) for sub in subs if (index, sub) in self.entries), None)

    def meaning_of_profiles(self, index: int, sub_index: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for profile in self.profiles:
            for name, value in stated(profile["meaning"], index, sub_index).items():
                result.setdefault(name, value)
        return result

    def meaning(self, item: str) -> dict[str, Any]:
        entry = self.first_entry(item)
        if entry is None:
            return {}
        result = stated({key: value for key, value in self.options.items() if key != "emcy"}, *entry)
        same = result.get("same_as")
        keys = self.entries[entry]
        if "Unit" in keys and "unit" not in result:
            result |= {"unit": keys["Unit"], "scale": keys.get("Factor", "1"), "offset": keys.get("Offset", "0")}
        if same is not None:
            result = {name: value for name, value in self.meaning(same).items() if name != "same_as"} | result
        return self.meaning_of_profiles(*entry) | result

    def facts(self, item: str) -> Facts:
        return facts_of(item, self.meaning(item))

    def error_codes(self) -> Facts:
        codes: dict[str, Any] = {}
        for profile in reversed(self.profiles):
            codes |= profile.get("emcy", {})
        return facts_of_codes(codes | self.options.get("emcy", {}))


def facts_of_codes(codes: dict[str, Any]) -> Facts:
    text = lambda value: value if isinstance(value, str) else value["text"]
    return {("emcy", "error_code", code, joined(text(value))) for code, value in codes.items()}


def joined(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


def compare(device: Device, rows: list[Row], file: str, problems: list[str]) -> None:
    known: Facts = set()
    of_object: dict[str, Facts] = {"emcy": device.error_codes()}
    for row in rows:
        fact = row.fact() if row.object != "emcy" else ("emcy", row.kind, row.bits, joined(row.name))
        known.add(fact)
        if row.object != "emcy" and device.first_entry(row.object) is None:
            problems.append(f"{file}:{row.line}: {device.name} does not have {row.object}")
            continue
        if row.object not in of_object:
            of_object[row.object] = device.facts(row.object)
        if fact not in of_object[row.object]:
            problems.append(f"{file}:{row.line}: {device.name} does not have {row.object} {row.kind} {row.bits} {row.name}")
    for item, stated_meaning in device.options.items():
        if item == "emcy":
            facts = facts_of_codes(stated_meaning)
            allowed = known
            places = all("place" in code for code in stated_meaning.values())
        else:
            # Entries with the same meaning as another have its rows.
            entry = device.first_entry(item)
            if entry is None:
                problems.append(f"{device.name}.options.json: {item} does not exist")
                continue
            facts = facts_of(item, stated_meaning) - {(item, "same_as", "", stated_meaning.get("same_as", ""))}
            allowed = known | facts_of(item, device.meaning_of_profiles(*entry))
            places = "place" in stated_meaning
        for _, kind, bits, name in sorted(facts - allowed):
            problems.append(f"{device.name}.options.json: {item} {kind} {bits} {name}: not in {file}")
        if not places:
            problems.append(f"{device.name}.options.json: {item} has no place in the manual")


def check_words(rows: list[Row], file: str, problems: list[str]) -> None:
    """A name consists of words of the manual, except where the words refer to another document."""
    for row in rows:
        if row.kind in ("field", "value", "masked") and "Same as object" not in row.words:
            if strange := words_of(row.name.replace("_", " ")) - words_of(row.words) - {"reserved"}:
                problems.append(f"{file}:{row.line}: the words of the manual do not have {', '.join(sorted(strange))}")


def check_tables(path: Path, rows: list[Row], problems: list[str]) -> None:
    listed: list[str] = []
    for line, text in enumerate(path.read_text(encoding="utf-8").splitlines()[1:], 2):
        cells = text.split("\t")
        if len(cells) != 4 or not all(cells) or cells[2] not in ("typed", "not typed"):
            problems.append(f"{path.name}:{line}: expected place, table, typed or not typed, and objects or the reason")
        elif cells[2] == "typed":
            listed.append(cells[3])
    if not listed or not rows:
        problems.append(f"{path.name}: no typed table")


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    problems: list[str] = []
    folder = source / "tests" / "manuals" / "meaning"
    count = 0
    for manual, names in DEVICES.items():
        path = folder / f"{manual}.tsv"
        if not path.exists():
            continue
        rows = read_rows(path, problems)
        count += len(rows)
        if all(row.device == "all" for row in rows):
            check_words(rows, path.name, problems)
        check_tables(folder / f"{manual}_tables.tsv", rows, problems)
        for name in names:
            compare(Device(source, name), [row for row in rows if row.device in ("all", name)], path.name, problems)
    print("\n".join(problems) if problems else f"{count} rows of the manuals are the meaning of the devices")
    return 1 if problems or not count else 0


if __name__ == "__main__":
    sys.exit(main())
