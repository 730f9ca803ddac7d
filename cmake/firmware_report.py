#!/usr/bin/env python3
"""What an image costs: flash and RAM, its largest symbols, and the bytes of each object of the data sheet.

    firmware_report.py IMAGE DICTIONARY REPORT [--prefix arm-none-eabi-] [--flash-limit N] [--ram-limit N]

IMAGE is linked, DICTIONARY the dictionary.hpp that edsc has generated for it. The whole goes into REPORT, one line of it to
standard output. An image over a limit is an error, which names the largest symbols and objects.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

TABLE = re.compile(r"inline constexpr [\w:]+ (\w+)\[\] = \{\n(.*?)\n\};", re.DOTALL)
STRUCT = re.compile(r"^( *)struct (\w+) \{\n(.*?)\n\1\}", re.DOTALL | re.MULTILINE)
MEMBER = re.compile(r"^ *([\w:<>, ]+) (\w+);(?: +///< ([0-9A-F]{4})h.*)?$", re.MULTILINE)
INDEX = re.compile(r"// ([0-9A-F]{4})h")
SCALAR = re.compile(r"(?:std::)?(u?int(\d+)_t|bool|float|double)")
IN_FLASH, IN_RAM = "tTrRwWvV", "bBdD"
SHOWN = 12


@dataclass(frozen=True)
class Symbol:
    name: str
    size: int  # bytes
    kind: str  # as nm tells it


@dataclass(frozen=True)
class Image:
    flash: int  # bytes
    ram: int
    symbols: list[Symbol]  # the largest first

    def size_of(self, table: str) -> int:
        """Of a table of the dictionary; 0: it is not in the image."""
        return next((symbol.size for symbol in self.symbols if symbol.name.endswith(f"::{table}")), 0)


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def read_image(path: Path, prefix: str) -> Image:
    text, data, bss = (int(number) for number in output(f"{prefix}size", path).splitlines()[1].split()[:3])
    rows = (line.split(maxsplit=3) for line in output(f"{prefix}nm", "-C", "-S", "--size-sort", "-r", path).splitlines())
    return Image(text + data, data + bss, [Symbol(name, int(size, 16), kind) for _, size, kind, name in rows])


def short_name(name: str) -> str:
    """Without template arguments and parameters."""
    name = name.replace("(anonymous namespace)::", "").replace("operator()", "operator")
    while (shorter := re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", name)) != name:
        name = shorter
    return name.removesuffix(" const").rsplit(" ", 1)[-1]


class Dictionary:
    """The generated tables, row by row."""

    def __init__(self, text: str) -> None:
        self.tables = {name: rows.splitlines() for name, rows in TABLE.findall(text)}
        self.structs = {name: MEMBER.findall(body) for _, name, body in STRUCT.findall(text)}
        for name, body in re.findall(r"^  struct (\w+) \{\n(.*?)^  \}", text, re.DOTALL | re.MULTILINE):
            self.structs[name] = MEMBER.findall(body)

    def bytes_of(self, kind: str) -> int:
        """Of a value; without what aligns it in a struct."""
        if match := SCALAR.fullmatch(kind):
            return int(match[2]) // 8 if match[2] else {"bool": 1, "float": 4, "double": 8}[match[1]]
        if match := re.fullmatch(r"std::array<(.+), (\d+)>", kind):
            return self.bytes_of(match[1]) * int(match[2])
        if match := re.fullmatch(r"canopen::\w+<(\d+)>", kind):
            return int(match[1])
        if kind == "canopen::Domain":
            return 12
        return sum(self.bytes_of(member) for member, _, _ in self.structs.get(kind, ()))

    def members(self, *structs: str) -> Counter[str]:
        """Bytes of each object in these structs."""
        found: Counter[str] = Counter()
        for struct in structs:
            for kind, _, index in self.structs.get(struct, ()):
                found[index] += self.bytes_of(kind)
        return found

    def flash(self, image: Image) -> Counter[str]:
        found: Counter[str] = Counter()
        for table, rows in self.tables.items():
            size = image.size_of(f"table::{table}")
            index = ""
            for row in rows if table != "runs" else ():
                if match := INDEX.search(row):
                    index = match[1]
                found[index] += size // len(rows)
        for symbol, struct in (("communication_preset", "CommunicationPreset"), ("application_preset", "ApplicationPreset"),
                               ("constants", "Constants")):
            if image.size_of(symbol):
                found += self.members(struct)
        return found

    def ram(self) -> Counter[str]:
        return self.members("CommunicationPreset", "CommunicationCleared", "ApplicationPreset", "ApplicationCleared")


def symbols_text(image: Image, kinds: str) -> list[str]:
    shown = [symbol for symbol in image.symbols if symbol.kind in kinds][:SHOWN]
    return [f"  {symbol.size:6}  {short_name(symbol.name)}" for symbol in shown]


def objects_text(flash: Counter[str], ram: Counter[str], most: int | None = None) -> list[str]:
    both = flash + ram
    return [f"  {index}h  {flash[index]:6}  {ram[index]:6}" for index, _ in (
        both.most_common(most) if most else sorted(both.items())) if index]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("image", "dictionary", "report"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--prefix", default="arm-none-eabi-")
    for name in ("--flash-limit", "--ram-limit"):
        parser.add_argument(name, type=int)
    arguments = parser.parse_args()

    image = read_image(arguments.image, arguments.prefix)
    dictionary = Dictionary(arguments.dictionary.read_text(encoding="utf-8"))
    flash, ram = dictionary.flash(image), dictionary.ram()
    limits = ((image.flash, arguments.flash_limit, "flash", IN_FLASH), (image.ram, arguments.ram_limit, "RAM", IN_RAM))

    sums = ", ".join(f"{used} bytes of {what}" + (f" (limit {limit})" if limit else "") for used, limit, what, _ in limits)
    line = f"{arguments.image.name}: {sums}; the data sheet's objects: {flash.total()} and {ram.total()}"
    heading = "object  flash     RAM"
    arguments.report.write_text("\n".join([
        line, "", "largest in flash", *symbols_text(image, IN_FLASH), "", "largest in RAM", *symbols_text(image, IN_RAM), "",
        heading, *objects_text(flash, ram), ""]), encoding="utf-8")
    print(line)
    over = [(used, limit, what, kinds) for used, limit, what, kinds in limits if limit and used > limit]
    for used, limit, what, kinds in over:
        print(f"error: {arguments.image.name} has {used} bytes of {what}, {used - limit} more than its limit of {limit}")
        print(f"largest in {what}:", *symbols_text(image, kinds), sep="\n")
    if over:
        print("the data sheet's largest objects:", f"  {heading}", *objects_text(flash, ram, SHOWN), sep="\n")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
