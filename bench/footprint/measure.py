#!/usr/bin/env python3
"""What a device costs on a Cortex-M: flash and RAM of a whole node, of its services and of its dictionary, and the
instructions of what it does all the time, beside other stacks.

    measure.py EDSC RUNTIME_INCLUDE [--functions] [--markdown]

Bytes are those of images for a Cortex-M0+ at -Os, linked, without those of an empty program: NMT slave, boot-up, heartbeat,
SDO server, EMCY with a history, SYNC and 4 + 4 PDOs for ref.eds. Instructions are those of a Cortex-M4 at -O2, counted by
QEMU, and exact: the loop that asks and the store of the frame are in them. `--functions` lists what is in the images.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
SHEETS = HERE.parent
COMPILER = ("arm-none-eabi-g++", "-std=c++20", "-mthumb", "-ffunction-sections", "-fdata-sections", "-fno-exceptions",
            "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wno-register", "--specs=nano.specs",
            "-nostartfiles", "-Wl,--gc-sections", f"-T{SHEETS / 'cortex_m/firmware.ld'}")
SMALL = ("-mcpu=cortex-m0plus", "-Os")
FAST = ("-mcpu=cortex-m4", "-O2", "-DCOUNT")


@dataclass(frozen=True)
class Variant:
    """A device: its data sheet and what is asked of edsc."""

    sheet: str
    static_mapping: bool = False
    block_transfer: bool = False
    without: tuple[str, ...] = ()  # indices that the sheet loses, as regular expressions

    @property
    def name(self) -> str:
        parts = [self.sheet, "static" * self.static_mapping, "block" * self.block_transfer, *self.without]
        return re.sub(r"\W+", "_", "_".join(filter(None, parts)))


STATIC = Variant("ref", static_mapping=True)
DYNAMIC = Variant("ref")
BLOCK = Variant("ref", block_transfer=True)
SERVER = Variant("bench100")
BLOCK_SERVER = Variant("bench100", block_transfer=True)


@dataclass(frozen=True)
class Row:
    """A figure beside the best of other stacks; both are bytes, or both instructions."""

    what: str
    value: float
    peer: float
    peer_name: str
    mark: float


@dataclass(frozen=True)
class Size:
    flash: int
    ram: int


class Bench:
    def __init__(self, edsc: Path, runtime: Path, folder: Path):
        self.edsc, self.runtime, self.folder = edsc, runtime, folder
        self.empty = self.size("empty", STATIC)

    def headers(self, variant: Variant) -> Path:
        """The folder with device/device.hpp."""
        made = self.folder / variant.name
        if made.exists():
            return made
        made.mkdir()
        sheet = made / "device.eds"
        sheet.write_text(without(variant.without, (SHEETS / f"{variant.sheet}.eds").read_text(encoding="utf-8")),
                         encoding="utf-8")
        if variant.block_transfer:
            (made / "device.options.json").write_text('{ "sdo_block_transfer": true }', encoding="utf-8")
        flags = ["--static-mapping"] if variant.static_mapping else []
        subprocess.run([self.edsc, "generate", sheet, "-o", made, "--name", "device", *flags], check=True,
                       capture_output=True)
        return made

    def build(self, program: str, variant: Variant, flags: Sequence[str]) -> Path:
        made = self.folder / f"{program}_{variant.name}_{flags[0].rsplit('-', 1)[1]}.elf"
        if not made.exists():
            subprocess.run([*COMPILER, *flags, f"-I{self.runtime}", f"-I{self.headers(variant)}", HERE / f"{program}.cpp",
                            "-o", made], check=True)
        return made

    def size(self, program: str, variant: Variant) -> Size:
        """Of the whole image."""
        text, data, bss = (int(word) for word in output("arm-none-eabi-size", self.build(program, variant, SMALL))
                           .splitlines()[1].split()[:3])
        return Size(text + data, data + bss)

    def cost(self, program: str, variant: Variant) -> Size:
        """Above an empty program."""
        size = self.size(program, variant)
        return Size(size.flash - self.empty.flash, size.ram - self.empty.ram)

    def instructions(self, program: str, variant: Variant) -> dict[str, float]:
        made = self.build(program, variant, FAST)
        printed = subprocess.run(["qemu-system-arm", "-M", "mps2-an386", "-icount", "shift=0", "-semihosting",
                                  "-nographic", "-kernel", made], check=False, capture_output=True, text=True, timeout=120,
                                 stdin=subprocess.DEVNULL).stderr
        return {name: float(number) for name, number in map(str.split, printed.splitlines())}

    def functions(self, program: str, variant: Variant) -> list[tuple[int, str, str]]:
        """Bytes, kind of memory and name of what is in an image, the largest first."""
        listed = output("arm-none-eabi-nm", "-C", "-S", "--size-sort", "-r", self.build(program, variant, SMALL))
        return [(int(size, 16), kind, short_name(name))
                for _, size, kind, name in (line.split(maxsplit=3) for line in listed.splitlines())]


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def without(indices: Iterable[str], sheet: str) -> str:
    """A data sheet without the objects whose index one of these patterns matches."""
    for pattern in indices:
        sheet = re.sub(rf"(?im)^\[(?:{pattern})(?:sub[0-9A-F]+)?\]\n(?:[^\[\n].*\n|\n)*", "", sheet)
        sheet = re.sub(rf"(?im)^\d+=0x(?:{pattern})\n", "", sheet)
    return renumbered(sheet)


def renumbered(sheet: str) -> str:
    """Object lists count from 1 without a gap."""
    def numbered(match: re.Match[str]) -> str:
        indices = re.findall(r"(?m)^\d+=(0x[0-9A-Fa-f]+)$", match[2])
        return "\n".join([f"[{match[1]}]", f"SupportedObjects={len(indices)}",
                          *(f"{i}={index}" for i, index in enumerate(indices, 1)), "", ""])
    return re.sub(r"(?m)^\[(MandatoryObjects|OptionalObjects|ManufacturerObjects)\]\n((?:[^\[\n].*\n|\n)*)", numbered, sheet)


def short_name(name: str) -> str:
    """Without template arguments and parameters."""
    while (shorter := re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", name)) != name:
        name = shorter
    return name


def sizes(bench: Bench) -> list[Row]:
    static, dynamic, block = (bench.cost("node", variant) for variant in (STATIC, DYNAMIC, BLOCK))
    node = "CANopenNode"
    return [
        Row("flash, static mapping", static.flash, 13132, node, 5000),
        Row("flash, dynamic mapping", dynamic.flash, 15672, node, 5800),
        Row("flash, dynamic mapping, block transfer with CRC", block.flash, 18032, node, 7000),
        Row("RAM, static mapping", static.ram, 1012, "modm-canopen", 550),
        Row("RAM, dynamic mapping", dynamic.ram, 3200, "canopen-stack", 700),
    ]


def counts(bench: Bench) -> list[Row]:
    look_up_100 = bench.instructions("look_up", Variant("bench100"))["look-up"]
    look_up_1000 = bench.instructions("look_up", Variant("bench1000"))["look-up"]
    server, block = bench.instructions("sdo_server", SERVER), bench.instructions("sdo_server", BLOCK_SERVER)
    static = bench.instructions("pdo", Variant("bench100", static_mapping=True))
    dynamic = bench.instructions("pdo", Variant("bench100"))
    return [
        Row("look-up of a random entry, 100 indices", look_up_100, 53, "CanFestival", 50),
        Row("look-up of a random entry, 1000 indices", look_up_1000, 44, "CanFestival", 45),
        Row("expedited upload, server alone", server["expedited-upload"], 283, "canopen-stack", 125),
        Row("expedited download, server alone", server["expedited-download"], 272, "canopen-stack", 140),
        Row("segmented upload, per byte", server["segmented-upload-per-byte"], 36, "CANopenNode", 12),
        Row("segmented download, per byte", server["segmented-download-per-byte"], 36, "CANopenNode", 15),
        Row("block upload with CRC, per byte", block["block-upload-per-byte"], 33, "CANopenNode", 14),
        Row("block download with CRC, per byte", block["block-download-per-byte"], 33, "CANopenNode", 20),
        Row("TPDO of 4 objects, built", static["tpdo"], 171, "CANopenNode", 33),
        Row("RPDO of 4 objects, taken", static["rpdo"], 150, "CANopenNode", 26),
        Row("SYNC, 4 RPDOs and 4 TPDOs, static mapping", static["sync-cycle"], 1651, "CANopenNode", 450),
        Row("SYNC, 4 RPDOs and 4 TPDOs, dynamic mapping", dynamic["sync-cycle"], 1651, "CANopenNode", 950),
    ]


def print_rows(title: str, rows: Iterable[Row]) -> None:
    print(f"{title:<50}{'edsc':>8}{'mark':>8}{'':3}{'peer':>8}{'ratio':>7}")
    for row in rows:
        missed = "" if row.value <= row.mark else " !"
        print(f"{row.what:<50}{row.value:8g}{row.mark:8g}{missed:3}{row.peer:8g}{row.value / row.peer:7.2f}  {row.peer_name}")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("edsc", type=Path)
    parser.add_argument("runtime", type=Path)
    parser.add_argument("--functions", action="store_true", help="list what is in the images")
    parser.add_argument("--sizes", action="store_true", help="sizes alone")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments.edsc.resolve(), arguments.runtime.resolve(), Path(folder))
        print_rows("bytes, Cortex-M0+ -Os", sizes(bench))
        if not arguments.sizes:
            print_rows("instructions, Cortex-M4 -O2", counts(bench))
        if arguments.functions:
            for variant in (STATIC, DYNAMIC, BLOCK):
                print(f"\n{variant.name}")
                for size, kind, name in bench.functions("node", variant):
                    print(f"{size:6} {kind} {name}")


if __name__ == "__main__":
    main()
