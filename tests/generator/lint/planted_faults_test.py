#!/usr/bin/env python3
"""Faults that are planted in the EDS files of eds/ are found, and a fault of the whole file is one cause.

    planted_faults_test.py SOURCE_DIR EDSC

`SINGLE` has a fault in one place: a change of the text, and the rule that reports it. It is planted in each of the files that it fits, at
a random place of those that the change has; the finding must be listed, also if it is counted below another one, and name a line of the
change. `SYSTEMATIC` has a fault in all places, as a tool makes it: its rule must be reported, and the file must not have more than
two causes besides those that it has without the fault.
"""

from __future__ import annotations

import json
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

SEED = 20
FILES_PER_FAULT = 2
MORE_CAUSES = 2  # of a systematic fault

# A change returns the new text, or None if the file does not have its place.
Change = Callable[[str, random.Random], "str | None"]


def lines_with(text: str, pattern: str) -> list[re.Match[str]]:
    return list(re.finditer(pattern, text, re.MULTILINE))


def replace(pattern: str, by: str | Callable[[re.Match[str]], str]) -> Change:
    """Replaces one of the places of a pattern."""

    def change(text: str, chance: random.Random) -> str | None:
        places = lines_with(text, pattern)
        if not places:
            return None
        at = chance.choice(places)
        return text[: at.start()] + (at.expand(by) if isinstance(by, str) else by(at)) + text[at.end() :]

    return change


def each(pattern: str, by: str | Callable[[re.Match[str]], str]) -> Change:
    def change(text: str, _: random.Random) -> str | None:
        changed, count = re.subn(pattern, by, text, flags=re.MULTILINE)
        return changed if count > 1 else None

    return change


def entry(section: str, key: str, value: str) -> Change:
    """Sets a key of one section of a pattern that has it."""
    return replace(rf"^(\[{section}\]\n(?:[^\[\n].*\n|\n)*?{key}=)[^\n]*$", lambda at: at[1] + value)


def without(section: str) -> Change:
    """Removes a section."""
    return replace(rf"^\[{section}\]\n(?:[^\[\n].*\n|\n)*", "")


def without_key(section: str, key: str) -> Change:
    return replace(rf"^(\[{section}\]\n(?:[^\[\n].*\n|\n)*?){key}=[^\n]*\n", r"\1")


def after(section: str, line: str) -> Change:
    return replace(rf"^\[{section}\]\n", lambda at: at[0] + line + "\n")


def add(text_to_add: str) -> Change:
    return lambda text, _: text.rstrip("\n") + "\n\n" + text_to_add + "\n"


VAR = "ParameterName=Planted\nObjectType=0x7\nDataType={}\nAccessType={}\n"
MANUFACTURER = "[2-5][0-9A-F]{3}"
MAPPED = "1A0[0-9A-F]sub[1-8]"

SINGLE: list[tuple[str, Change]] = [
    # lines and sections
    ("stray-line", after("DeviceInfo", "this is not an entry")),
    ("hash-comment", after("DeviceInfo", "# a comment of another syntax")),
    ("unterminated-section", replace(r"^\[1000\]$", "[1000")),
    ("text-after-section", replace(r"^\[1000\]$", "[1000] device type")),
    ("entry-outside-section", lambda text, _: "VendorName=Planted\n" + text),
    ("duplicate-section", add("[1000]\n" + VAR.format("0x0007", "ro"))),
    ("duplicate-key", after("1001", "DataType=0x0005")),
    ("unknown-section", add("[Planted]\nKey=1")),
    ("section-name", add("[1018sub100]\n" + VAR.format("0x0007", "ro"))),
    ("unknown-key", after("1000", "PlantedKey=1")),
    # [FileInfo] and [DeviceInfo]
    ("file-info", without("FileInfo")),
    ("file-name", entry("FileInfo", "FileName", "planted.eds")),
    ("file-version", entry("FileInfo", "FileVersion", "1.2.3")),
    ("eds-version", entry("FileInfo", "EDSVersion", "four")),
    ("file-date", entry("FileInfo", "CreationDate", "2026/11/20")),
    ("file-time", entry("FileInfo", "CreationTime", "25:00")),
    ("no-device-info", without("DeviceInfo")),
    ("device-info-flag", entry("DeviceInfo", "LSS_Supported", "yes")),
    ("baud-rates", each(r"^BaudRate_(\d+)=1$", r"BaudRate_\1=0")),
    ("granularity", entry("DeviceInfo", "Granularity", "128")),
    ("pdo-count", entry("DeviceInfo", "NrOfTXPDO", "77")),
    ("vendor-number", entry("DeviceInfo", "VendorNumber", "0x12345678")),
    ("product-number", entry("DeviceInfo", "ProductNumber", "0x12345678")),
    ("revision-number", entry("DeviceInfo", "RevisionNumber", "0x12345678")),
    ("dummy-usage", replace(r"^(Dummy000[1-7])=[01]$", r"\1=7")),
    # object lists
    ("object-list-count", replace(r"^SupportedObjects=(\d+)$", lambda at: f"SupportedObjects={int(at[1]) + 3}")),
    ("object-without-section", without("1001")),
    ("object-not-listed", replace(r"^\d+=0x1017\n", "")),
    ("object-list", replace(r"^(\d+)=0x1000$", r"\1=0x1000\n77=0x1000")),
    ("mandatory-object", lambda text, _: re.sub(r"(?m)^\d+=0x1001\n", "", without("1001")(text, _) or "")),
    # objects
    ("object-type", replace(r"^(\[1018\]\n(?:[^\[\n].*\n)*?ObjectType=)0x9$", r"\g<1>0x7")),
    ("object-type", replace(r"^(\[1000\]\n(?:[^\[\n].*\n)*?ObjectType=)0x7$", r"\g<1>0x42")),
    ("standard-object-type", replace(r"^(\[1018\]\n(?:[^\[\n].*\n)*?ObjectType=)0x9$", r"\g<1>0x8")),
    ("sub-number", replace(r"^SubNumber=(\d+)$", lambda at: f"SubNumber={int(at[1]) + 1}")),
    ("sub-index-0", without("1018sub0")),
    ("sub-index-0-type", entry("1018sub0", "DataType", "0x0006")),
    ("sub-index-0-access", entry("1018sub0", "AccessType", "rw")),
    ("sub-index-0-value", entry("1018sub0", "DefaultValue", "9")),
    ("sub-object-without-object", add("[5FF0sub1]\n" + VAR.format("0x0007", "ro"))),
    ("no-sub-objects", add("[5FF0]\nParameterName=Planted\nObjectType=0x9\nSubNumber=0")),
    ("parameter-name", without_key("1000", "ParameterName")),
    ("data-type", without_key("1001", "DataType")),
    ("data-type", entry("1000", "DataType", "0x0999")),
    ("data-type", entry("1000", "DataType", "DWORD?")),
    ("access-type", entry("1000", "AccessType", "readable")),
    ("access-type", without_key("1000", "AccessType")),
    ("pdo-mapping", replace(r"^PDOMapping=[01]$", "PDOMapping=yes")),
    ("standard-data-type", entry("1000", "DataType", "0x0006")),
    ("standard-access", entry("1001", "AccessType", "rw")),
    ("standard-sub-index-missing", without("1018sub1")),
    ("standard-sub-index", add("[1018sub9]\n" + VAR.format("0x0007", "ro"))),
    # values
    ("number-format", entry("1000", "DefaultValue", "twelve")),
    ("number-range", entry("1001", "DefaultValue", "0x1FF")),
    ("number-spelling", replace(r"^(DefaultValue=)0x([0-9A-F]+)$", r"\g<1>\2h")),
    ("node-id-formula", replace(r"^DefaultValue=\$NODEID\+0x([0-9A-F]+)$", r"DefaultValue=$NODE*2+0x\1")),
    ("limits-order", replace(r"^LowLimit=\d+$", "LowLimit=65000\nHighLimit=3")),
    ("default-outside-limits",
     replace(r"^(\[1017\]\n(?:(?!LowLimit)[^\[\n].*\n)*?)DefaultValue=.*$", r"\1LowLimit=60000\nDefaultValue=3")),
    ("parameter-value", after("1000", "ParameterValue=1")),
    # CAN-IDs and PDOs
    ("cob-id-node-id", entry("1800sub1", "DefaultValue", "0x185")),
    ("cob-id-restricted", entry("1014", "DefaultValue", "0x00000005")),
    ("cob-id-frame", entry("1014", "DefaultValue", "0x00012345")),
    ("pdo-object", replace(rf"^(\[{MAPPED}\]\n(?:[^\[\n].*\n)*?DefaultValue=)0x[2-9][0-9A-F]{{7}}$", r"\g<1>0x5FEF0008")),
    ("pdo-length", replace(rf"^(\[{MAPPED}\]\n(?:[^\[\n].*\n)*?DefaultValue=0x[0-9A-F]{{6}})[12][08]$", r"\g<1>07")),
    ("sub-object-without-object", without("1A00")),
    ("pdo-pair", each(r"^\[1A00(?:sub[0-9A-F]+)?\]\n(?:[^\[\n].*\n|\n)*", "")),
    ("pdo-transmission-type", entry("1800sub2", "DefaultValue", "245")),
    ("pdo-mapping-count", entry("1A00sub0", "DefaultValue", "60")),
    ("sync-counter", add("[1019]\n" + VAR.format("0x0005", "rw") + "DefaultValue=241")),
]


def types_moved(by: int) -> Change:
    return each(r"^DataType=0x([0-9A-F]{4})$", lambda at: f"DataType=0x{int(at[1], 16) + by:04X}")


SYSTEMATIC: list[tuple[str, str, Change]] = [
    ("all data types one too high", "shifted-data-types", types_moved(1)),
    ("all data types one too low", "shifted-data-types", types_moved(-1)),
    ("node-ID 1 in each CAN-ID", "cob-id-node-id",
     each(r"\$NODEID\+0x([0-9A-F]+)", lambda at: f"0x{int(at[1], 16) + 1:X}")),
    ("no node-ID in CAN-IDs of RPDOs", "cob-id-node-id",
     each(r"^(DefaultValue=)\$NODEID\+0x([2345]00)$", r"\g<1>0x\2")),
    ("access types as letters", "access-type",
     each(r"^AccessType=(ro|rw|wo|const)$", lambda at: "AccessType=" + {"ro": "R", "rw": "R/W", "wo": "W"}.get(at[1], at[1]))),
    ("no lists of objects", "object-not-listed", each(r"^\[(?:Optional|Manufacturer)Objects\]\n(?:[^\[\n].*\n|\n)*", "")),
    ("no SubNumber fits", "sub-number", each(r"^SubNumber=(\d+)$", lambda at: f"SubNumber={int(at[1]) - 1}")),
    ("no object codes", "object-type", each(r"^ObjectType=.*\n", "")),
    ("objects with sub-objects are VARs", "object-type", each(r"^ObjectType=0x[89]$", "ObjectType=0x7")),
    ("values in quotation marks", "number-spelling", each(r"^DefaultValue=(0x[0-9A-F]+)$", r'DefaultValue="\1"')),
    ("values with a decimal point", "number-spelling", each(r"^DefaultValue=(\d+)$", r"DefaultValue=\1.0")),
    ("hexadecimal values end in h", "number-spelling", each(r"^DefaultValue=0x([0-9A-F]+)$", r"DefaultValue=\1h")),
    ("limits without meaning", "number-format", each(r"^(Low|High)Limit=.*$", r"\1Limit=n/a")),
    ("data types by name", "data-type",
     each(r"^DataType=0x000([567])$", lambda at: f"DataType=UNSIGNED{8 << (int(at[1]) - 5)}")),
    ("the file twice", "duplicate-section", lambda text, _: text + "\n" + text),
    ("no section DeviceInfo", "no-device-info", without("DeviceInfo")),
    ("no data type of sub-index 0", "data-type",
     each(r"^(\[[0-9A-F]{4}sub0\]\n(?:[^\[\n].*\n)*?)DataType=.*\n", r"\1")),
    ("sub-indices are decimal", "sub-index-base",
     lambda text, _: re.sub(r"(?m)^\[([0-9A-F]{4})sub([0-9A-F]+)\]$", lambda at: f"[{at[1]}sub{int(at[2], 16)}]", text)
     if "subA]" in text else None),
]


class Checker:
    def __init__(self, edsc: Path, folder: Path) -> None:
        self.edsc, self.folder, self.problems = edsc, folder, []

    def report(self, name: str, text: str) -> dict:
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        ran = subprocess.run([self.edsc, "check", path, "--format", "json"], capture_output=True, text=True, timeout=600)
        if ran.returncode > 1:
            self.problems.append(f"{name}: exit code {ran.returncode}: {ran.stderr}")
        return json.loads(ran.stdout)

    def plant(self, rule: str, change: Change, number: int, sheets: dict[str, str], chance: random.Random) -> int:
        planted = 0
        for name in chance.sample(sorted(sheets), len(sheets)):
            text = change(sheets[name], chance)
            if text is None or text == sheets[name]:
                continue
            report = self.report(name, text)
            before = {line for line in sheets[name].splitlines()}
            found = [one for one in report["diagnostics"] if one["rule"] == rule]
            if not found:
                rules = sorted({one["rule"] for one in report["diagnostics"]})
                self.problems.append(f"fault {number}, {rule}: not found in {name}; rules found: {rules}")
            elif text.count("\n") >= sheets[name].count("\n") and not is_at_change(found, text, before):
                self.problems.append(f"fault {number}, {rule}: reported in {name} at {[one['line'] for one in found]} only")
            planted += 1
            if planted == FILES_PER_FAULT:
                break
        if planted == 0:
            self.problems.append(f"fault {number}, {rule}: does not fit any file")
        return planted

    def plant_in_all_places(self, what: str, rule: str, change: Change, sheets: dict[str, str]) -> int:
        planted = 0
        for name, sheet in sheets.items():
            text = change(sheet, random.Random(SEED))
            if text is None or text == sheet:
                continue
            planted += 1
            before, report = self.report(name, sheet), self.report(name, text)
            causes = [one["rule"] for one in report["diagnostics"] if one["severity"] != "note" and "follows_from" not in one]
            if rule not in causes:
                self.problems.append(f"{what}: {rule} is not a cause in {name}: {causes}")
            if report["causes"] > before["causes"] + MORE_CAUSES:
                self.problems.append(f"{what}: {report['causes']} causes in {name}, {before['causes']} without the fault: {causes}")
        if planted == 0:
            self.problems.append(f"{what}: does not fit any file")
        return planted


def is_at_change(found: list[dict], text: str, before: set[str]) -> bool:
    """Whether a finding names a new line, its section, or the file as a whole."""
    lines = text.splitlines()
    new = {number for number, line in enumerate(lines, 1) if line not in before}
    if not new:
        return True
    sections = {max((at for at in range(1, number + 1) if lines[at - 1].startswith("[")), default=1) for number in new}
    places = {place["line"] for one in found for place in [one, *one["notes"]]}
    return bool(places & (new | sections | {1})) or len(new) > 3


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    sheets = {path.name: path.read_text(encoding="utf-8") for path in sorted((source / "eds").glob("*.eds"))}
    chance = random.Random(SEED)
    with tempfile.TemporaryDirectory() as folder:
        checker = Checker(edsc, Path(folder))
        planted = sum(checker.plant(rule, change, number, sheets, chance) for number, (rule, change) in enumerate(SINGLE, 1))
        systematic = sum(checker.plant_in_all_places(*row, sheets) for row in SYSTEMATIC)
    print("\n".join(checker.problems))
    print(f"{len(SINGLE)} kinds of faults planted {planted} times; {len(SYSTEMATIC)} systematic faults in {systematic} files; "
          f"{len(checker.problems)} problems")
    return 1 if checker.problems else 0


if __name__ == "__main__":
    sys.exit(main())
