#!/usr/bin/env python3
"""What an image costs: flash and RAM, its largest symbols, the bytes of each object of the data sheet, those that all
objects share, and the rest.

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
INDEX = re.compile(r"// ([0-9A-F]{4})h|object_key\(0x([0-9A-F]{4})")
SCALAR = re.compile(r"(?:std::)?(u?int(\d+)_t|bool|float|double)")
IN_FLASH, IN_RAM, IN_BOTH = "tTrRwWvV", "bBdD", "dD"
VALUES = ("CommunicationPreset", "CommunicationCleared", "ApplicationPreset", "ApplicationCleared")
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

    def sum_of(self, kinds: str) -> int:
        return sum(symbol.size for symbol in self.symbols if symbol.kind in kinds)


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def read_image(path: Path, prefix: str) -> Image:
    text, data, bss = (int(number) for number in output(f"{prefix}size", path).splitlines()[1].split()[:3])
    rows = (line.split(maxsplit=3) for line in output(f"{prefix}nm", "-C", "-S", "--size-sort", "-r", path).splitlines())
    places: dict[str, Symbol] = {}  # by address: a function may have several names
    for address, size, kind, name in rows:
        places.setdefault(address, Symbol(name, int(size, 16), kind))
    return Image(text + data, data + bss, list(places.values()))


def short_name(name: str) -> str:
    """Without template arguments, parameters and the marks of clones."""
    name = re.sub(r" \[clone [^]]*\]", "", name).replace("(anonymous namespace)::", "").replace("operator()", "operator")
    while (shorter := re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", name)) != name:
        name = shorter
    return name.removesuffix(" const").rsplit(" ", 1)[-1]


@dataclass(frozen=True)
class Parts:
    """Bytes of one memory. What is left is alignment between symbols, and texts without a name."""

    objects: Counter[str]  # by index
    shared: Counter[str]   # parts of the dictionary that no object has for itself
    code: int              # in RAM: what does not belong to the dictionary
    total: int

    @property
    def filling(self) -> int:
        return self.total - self.objects.total() - self.shared.total() - self.code

    def text(self) -> str:
        shared = ", ".join(f"{name} {size}" for name, size in sorted(self.shared.items()) if size)
        return (f"{self.objects.total()} of objects, {self.shared.total()} shared by them ({shared or 'nothing'}), "
                f"{self.code} of code and its data, {self.filling} between")


class Dictionary:
    """The generated tables, row by row."""

    def __init__(self, text: str) -> None:
        self.tables = {name: rows.splitlines() for name, rows in TABLE.findall(text)}
        self.structs = {name: MEMBER.findall(body) for _, name, body in STRUCT.findall(text)}
        for name, body in re.findall(r"^  struct (\w+) \{\n(.*?)^  \}", text, re.DOTALL | re.MULTILINE):
            self.structs[name] = MEMBER.findall(body)

    def layout(self, kind: str) -> tuple[int, int]:
        """Size and alignment of a value."""
        if match := SCALAR.fullmatch(kind):
            size = int(match[2]) // 8 if match[2] else {"bool": 1, "float": 4, "double": 8}[match[1]]
            return size, size
        if match := re.fullmatch(r"std::array<(.+), (\d+)>", kind):
            size, alignment = self.layout(match[1])
            return size * int(match[2]), alignment
        if match := re.fullmatch(r"canopen::\w+<(\d+)>", kind):  # a string: a length of 16 bits before its bytes
            return aligned(2 + int(match[1]), 2), 2
        if kind.startswith("canopen::"):
            return {"canopen::Domain": (12, 4), "canopen::TimeOfDay": (8, 4), "canopen::TimeDifference": (8, 4)}[kind]
        return self.layout_of_struct([member for member, _, _ in self.structs.get(kind, ())])

    def layout_of_struct(self, members: list[str]) -> tuple[int, int]:
        end, largest = 0, 1
        for member in members:
            size, alignment = self.layout(member)
            end = aligned(end, alignment) + size
            largest = max(largest, alignment)
        return aligned(end, largest), largest

    def bytes_of(self, kind: str) -> int:
        return self.layout(kind)[0]

    def members(self, *structs: str) -> Counter[str]:
        """Bytes of each object in these structs."""
        found: Counter[str] = Counter()
        for struct in structs:
            for kind, _, index in self.structs.get(struct, ()):
                found[index] += self.bytes_of(kind)
        return found

    def flash(self, image: Image) -> Parts:
        found: Counter[str] = Counter()
        sizes = Counter({"dictionary": image.size_of("dictionary")})
        for table, rows in self.tables.items():
            sizes[table] = image.size_of(f"table::{table}")
            index = ""
            for row in rows if table != "runs" else ():
                if match := INDEX.search(row):
                    index = match[1] or match[2]
                found[index] += sizes[table] // len(rows)
        for symbol, struct in (("communication_preset", "CommunicationPreset"), ("application_preset", "ApplicationPreset"),
                               ("constants", "Constants")):
            sizes[symbol] = image.size_of(symbol)
            if sizes[symbol]:
                found += self.members(struct)
        shared = Counter({"search": sizes["runs"] + sizes["dictionary"],
                          "alignment": sizes.total() - sizes["runs"] - sizes["dictionary"] - found.total()})
        return Parts(found, shared, image.sum_of(IN_FLASH + IN_BOTH) - sizes.total(), image.flash)

    def ram(self, image: Image) -> Parts:
        found = self.members(*VALUES)
        structs = [struct for struct in VALUES if struct in self.structs]
        shared = Counter({"alignment": self.layout_of_struct(structs)[0] - found.total()})
        return Parts(found, shared, image.sum_of(IN_RAM) - found.total() - shared.total(), image.ram)


def aligned(size: int, alignment: int) -> int:
    return -(-size // alignment) * alignment


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
    in_flash, in_ram = dictionary.flash(image), dictionary.ram(image)
    flash, ram = in_flash.objects, in_ram.objects
    limits = ((image.flash, arguments.flash_limit, "flash", IN_FLASH), (image.ram, arguments.ram_limit, "RAM", IN_RAM))

    sums = ", ".join(f"{used} bytes of {what}" + (f" (limit {limit})" if limit else "") for used, limit, what, _ in limits)
    line = f"{arguments.image.name}: {sums}, of which the objects of the EDS take {flash.total()} and {ram.total()}"
    heading = "object  flash     RAM"
    arguments.report.write_text("\n".join([
        line, f"flash: {in_flash.text()}", f"RAM: {in_ram.text()}", "",
        "largest in flash", *symbols_text(image, IN_FLASH), "", "largest in RAM", *symbols_text(image, IN_RAM), "",
        heading, *objects_text(flash, ram), ""]), encoding="utf-8")
    print(line)
    over = [(used, limit, what, kinds) for used, limit, what, kinds in limits if limit and used > limit]
    for used, limit, what, kinds in over:
        print(f"error: {arguments.image.name} has {used} bytes of {what}, {used - limit} more than its limit of {limit}")
        print(f"largest in {what}:", *symbols_text(image, kinds), sep="\n")
    if over:
        print("the largest objects of the EDS:", f"  {heading}", *objects_text(flash, ram, SHOWN), sep="\n")
    return 1 if over else 0


if __name__ == "__main__":
    sys.exit(main())
