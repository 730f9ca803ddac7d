"""Compares typed values with masks and numbers by hand: bytes and instructions of each pair of functions of twins.cpp. Its types are
those of a generated header."""

from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
SHEET = HERE.parents[1] / "tests/fixtures/typed_drive.eds"
COMPILER = ("arm-none-eabi-g++", "-std=c++20", "-mthumb", "-ffunction-sections", "-fno-exceptions", "-fno-rtti", "-fno-ipa-icf", "-Wall",
            "-Wextra")
TARGETS = {
    "M0+ -Os": ("-mcpu=cortex-m0plus", "-Os"),
    "M0+ -O2": ("-mcpu=cortex-m0plus", "-O2"),
    "M4 -Os": ("-mcpu=cortex-m4", "-Os"),
    "M4 -O2": ("-mcpu=cortex-m4", "-O2"),
}
ROWS = {
    "flag": "test a flag",
    "two_flags": "test two flags with `all`",
    "field": "read a field",
    "set_field": "write a field",
    "modify": "set one flag and clear another",
    "enumeration": "`switch` over an enumeration",
    "set_enumeration": "set an enumerator",
    "compare": "compare with a constant",
    "compare_in_kelvin": "compare with a constant in another unit",
    "set_constant": "set a constant",
    "add": "add a difference, clamped",
    "convert": "convert 16 bits to another unit",
    "convert_wide": "convert 32 bits to another unit",
    "pack": "pack three values into a PDO",
    "unpack": "unpack them",
}
FUNCTION = re.compile(r"^[0-9a-f]+ <(\w+)>:$")
INSTRUCTION = re.compile(r"^\s+[0-9a-f]+:\t([0-9a-f ]+)\t(\S+)")


@dataclass(frozen=True)
class Size:
    bytes: int
    instructions: int


def sizes(edsc: Path, runtime: Path, flags: tuple[str, ...]) -> dict[str, Size]:
    """Those of each function, with its constants."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([edsc, "generate", SHEET, "-o", folder], check=True, capture_output=True)
        target = Path(folder) / "twins.o"
        subprocess.run([*COMPILER, *flags, f"-I{runtime}", f"-I{folder}", "-c", HERE / "twins.cpp", "-o", target], check=True)
        text = subprocess.run(["arm-none-eabi-objdump", "-d", target], check=True, capture_output=True, text=True).stdout
    found: dict[str, Size] = {}
    name = ""
    for line in text.splitlines():
        if match := FUNCTION.match(line):
            name = match[1]
            found[name] = Size(0, 0)
        elif match := INSTRUCTION.match(line):
            is_constant = match[2].startswith(".")
            size = len(match[1].replace(" ", "")) // 2
            found[name] = Size(found[name].bytes + size, found[name].instructions + (0 if is_constant else 1))
    return found


def cell(typed: Size, by_hand: Size) -> str:
    if typed == by_hand:
        return f"{typed.bytes}, {typed.instructions}"
    return f"{typed.bytes}, {typed.instructions}; by hand {by_hand.bytes}, {by_hand.instructions}"


def table(edsc: Path, runtime: Path) -> list[str]:
    """Rows of Markdown: bytes and instructions. Where a twin differs, both."""
    of_target = {name: sizes(edsc, runtime, flags) for name, flags in TARGETS.items()}
    rows = ["| bytes, instructions | " + " | ".join(TARGETS) + " |", "|---|" + "--:|" * len(TARGETS)]
    for key, text in ROWS.items():
        cells = [cell(found[f"typed_{key}"], found[f"hand_{key}"]) for found in of_target.values()]
        rows.append(f"| {text} | " + " | ".join(cells) + " |")
    return rows
