#!/usr/bin/env python3
"""Measures a device on a Cortex-M: flash and RAM of a complete node, of each service and of the dictionary, and the
instructions of its frequent operations, compared with other stacks.

    measure.py EDSC RUNTIME_INCLUDE [--page | --tables | --functions]

Bytes are those of images for a Cortex-M0+ at -Os with link-time optimisation, as edsc_add_firmware builds them, without those of
an empty program: NMT slave, boot-up, heartbeat, SDO server, EMCY with a history, SYNC and 4 + 4 PDOs for ref.eds, and an
application (drive.hpp). Instructions are those of a Cortex-M4 at -O2 and of a Cortex-M0+ at -Os, counted exactly by QEMU, including
the loop that calls and the store of the frame. A `!` marks a missed mark.

`--page` prints docs/footprint.md, `--tables` its tables of whole devices and whole frames. `--functions` lists the contents of the images.
"""

from __future__ import annotations

import argparse
import hashlib
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
BENCH = HERE.parent
COMPILER = ("arm-none-eabi-g++", "-std=c++20", "-mthumb", "-ffunction-sections", "-fdata-sections", "-fno-exceptions",
            "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wno-register", "--specs=nano.specs",
            "-nostartfiles", "-Wl,--gc-sections", f"-T{BENCH / 'cortex_m/firmware.ld'}")
sys.path.insert(0, str(BENCH))
import other_stacks  # noqa: E402
import sheets  # noqa: E402
import twins  # noqa: E402
from other_stacks import BYTES, M0, M4, Other  # noqa: E402

SMALL = ("-mcpu=cortex-m0plus", "-Os", "-flto=auto")
# Builds whose instructions are counted. QEMU runs both on a Cortex-M4.
COUNTED = {M4: ("-mcpu=cortex-m4", "-O2", "-flto=auto", "-DCOUNT"), M0: (*SMALL, "-DCOUNT")}


@dataclass(frozen=True)
class Entry:
    """A VAR, or a sub-index, that is added to an EDS."""

    index: int
    data_type: int
    access: str = "rw"
    default: str = "0"
    sub_index: int | None = None
    array: int = 0  # number of elements; the entry is then the object

    @property
    def section(self) -> str:
        return f"{self.index:04X}" + (f"sub{self.sub_index:X}" if self.sub_index is not None else "")

    def text(self) -> str:
        keys = [f"[{self.section}]", f"ParameterName=Added {self.section}"]
        if self.array:
            keys += ["ObjectType=0x8", f"SubNumber={self.array + 1}"]
        else:
            keys += ["ObjectType=0x7", f"DataType=0x{self.data_type:04X}", f"AccessType={self.access}",
                     f"DefaultValue={self.default}", "PDOMapping=0"]
        return "\n".join(keys) + "\n\n"


U8, U16, U32 = 5, 6, 7


def array(index: int, data_type: int, elements: int) -> tuple[Entry, ...]:
    return (Entry(index, data_type, array=elements), Entry(index, U8, "const", str(elements), 0),
            *(Entry(index, data_type, sub_index=i + 1) for i in range(elements)))


@dataclass(frozen=True)
class Variant:
    """A device: its EDS and the options of edsc."""

    sheet: str
    static_mapping: bool = False
    block_transfer: bool = False
    without: str = ""  # the indices to remove from the EDS, as a regular expression
    added: tuple[Entry, ...] = ()

    @property
    def name(self) -> str:
        return f"{Path(self.sheet).name}_{hashlib.sha256(repr(self).encode()).hexdigest()[:12]}"


OPTIONAL = "10(?!00|01|18)[0-9A-F]{2}|1[1-9A-F][0-9A-F]{2}|[2-9A-F][0-9A-F]{3}"  # indices of optional objects
STATIC = Variant("ref", static_mapping=True)
DYNAMIC = Variant("ref")
BLOCK = Variant("ref", block_transfer=True)
SERVER = Variant("bench100")
BLOCK_SERVER = Variant("bench100", block_transfer=True)


@dataclass(frozen=True)
class Figure:
    """A measured value, its mark and the best figure of another stack."""

    value: float
    mark: float | None = None
    other: Other | None = None

    @property
    def mark_text(self) -> str:
        return "-" if self.mark is None else f"{self.mark:g}"

    @property
    def other_text(self) -> str:
        """The value of the other stack, with `q` if it is quoted."""
        return "-" if self.other is None else f"{self.other.value:g}{' q' if self.other.is_quoted else ''}"

    @property
    def other_and_stack(self) -> str:
        return "-" if self.other is None else f"{self.other_text}, {self.other.stack}"

    @property
    def ratio_text(self) -> str:
        return "-" if self.other is None else f"{self.value / self.other.value:.2f}"

    @property
    def missed_text(self) -> str:
        return " !" if self.mark is not None and self.value > self.mark else ""


@dataclass(frozen=True)
class Row:
    """A figure of a whole device, in bytes."""

    what: str
    figure: Figure


@dataclass(frozen=True)
class FrameRow:
    """The instructions of a whole frame, by the name of a build in COUNTED."""

    what: str
    figures: dict[str, Figure]


@dataclass(frozen=True)
class Size:
    flash: int
    ram: int


class Bench:
    def __init__(self, edsc: Path, runtime: Path, folder: Path):
        self.edsc, self.runtime, self.folder = edsc, runtime, folder
        self.empty = self.size("empty", STATIC)

    def headers(self, variant: Variant) -> Path:
        """Generates the code and returns the folder with device/device.hpp."""
        made = self.folder / variant.name
        if made.exists():
            return made
        made.mkdir()
        sheet = made / "device.eds"
        text = sheet_text(variant.sheet)
        sheet.write_text(changed(text, variant), encoding="latin-1")
        if variant.block_transfer:
            (made / "device.options.json").write_text('{ "sdo": { "block_transfer": true } }', encoding="utf-8")
        flags = ["--static-mapping"] if variant.static_mapping else []
        subprocess.run([self.edsc, "generate", sheet, "-o", made, "--name", "device", *flags], check=True,
                       capture_output=True)
        return made

    def build(self, program: str, variant: Variant, flags: Sequence[str]) -> Path:
        made = self.folder / f"{program}_{variant.name}_{flags[0].rsplit('-', 1)[1]}{'_counted' if '-DCOUNT' in flags else ''}.elf"
        if not made.exists():
            subprocess.run([*COMPILER, *flags, f"-I{self.runtime}", f"-I{self.headers(variant)}", HERE / f"{program}.cpp",
                            "-o", made], check=True)
        return made

    def size(self, program: str, variant: Variant) -> Size:
        """The size of the whole image."""
        return size_of(self.build(program, variant, SMALL))

    def cost(self, program: str, variant: Variant) -> Size:
        """The size without that of an empty program."""
        size = self.size(program, variant)
        return Size(size.flash - self.empty.flash, size.ram - self.empty.ram)

    def bytes_per_entry(self, sheet: str) -> float:
        """The flash of the dictionary per entry: the difference between a whole EDS and its mandatory objects alone."""
        whole, least = Variant(sheet, static_mapping=True), Variant(sheet, static_mapping=True, without=OPTIONAL)
        flash = self.cost("dictionary", whole).flash - self.cost("dictionary", least).flash
        return round(flash / (self.entries(whole) - self.entries(least)), 1)

    def entries(self, variant: Variant) -> int:
        text = (self.headers(variant) / "device/description.hpp").read_text(encoding="utf-8")
        return len(re.findall(r"(?m)^ +\{0x[0-9A-F]{4}, 0x[0-9A-F]{2}, ", text))

    def instructions(self, program: str, variant: Variant, build: str = "M4 -O2") -> dict[str, float]:
        return run(self.build(program, variant, COUNTED[build]))

    def functions(self, program: str, variant: Variant) -> list[tuple[int, str, str]]:
        """Size in bytes, type of memory and name of the symbols of an image, the largest first."""
        listed = output("arm-none-eabi-nm", "-C", "-S", "--size-sort", "-r", self.build(program, variant, SMALL))
        return [(int(size, 16), kind, short_name(name))
                for _, size, kind, name in (line.split(maxsplit=3) for line in listed.splitlines())]


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def size_of(image: Path) -> Size:
    text, data, bss = (int(word) for word in output("arm-none-eabi-size", image).splitlines()[1].split()[:3])
    return Size(text + data, data + bss)


def run(image: Path) -> dict[str, float]:
    """Runs a program under QEMU and returns the numbers that it prints, by their names."""
    printed = subprocess.run(["qemu-system-arm", "-M", "mps2-an386", "-icount", "shift=0", "-semihosting", "-nographic",
                              "-kernel", image], check=False, capture_output=True, text=True, timeout=120,
                             stdin=subprocess.DEVNULL).stderr
    return {name: float(number) for name, number in map(str.split, printed.splitlines())}


def changed(text: str, variant: Variant) -> str:
    """The EDS with objects removed and added."""
    if variant.without:
        text = re.sub(rf"(?im)^\[(?:{variant.without})(?:sub[0-9A-F]+)?\]\n(?:[^\[\n].*\n|\n)*", "", text)
        text = re.sub(rf"(?im)^\d+=0x(?:{variant.without})\n", "", text)
    objects = "".join(f"0=0x{entry.index:04X}\n" for entry in variant.added if entry.sub_index is None)
    text = text.replace("[OptionalObjects]\n", "[OptionalObjects]\n" + objects, 1)
    return renumbered(text + "\n" + "".join(entry.text() for entry in variant.added))


def sheet_text(name: str) -> str:
    """The text of an EDS of sheets.py, or of one with this path relative to bench/."""
    return sheets.make(name) if name in sheets.SHEETS else (BENCH / f"{name}.eds").read_text(encoding="latin-1")


def renumbered(sheet: str) -> str:
    """The EDS with its object lists numbered from 1 without gaps."""
    def numbered(match: re.Match[str]) -> str:
        indices = re.findall(r"(?m)^\d+=(0x[0-9A-Fa-f]+)$", match[2])
        return "\n".join([f"[{match[1]}]", f"SupportedObjects={len(indices)}",
                          *(f"{i}={index}" for i, index in enumerate(indices, 1)), "", ""])
    return re.sub(r"(?m)^\[(MandatoryObjects|OptionalObjects|ManufacturerObjects)\]\n((?:[^\[\n].*\n|\n)*)", numbered, sheet)


def short_name(name: str) -> str:
    """The name without template arguments and parameters."""
    while (shorter := re.sub(r"<[^<>]*>|\([^()]*\)|\{[^{}]*\}", "", name)) != name:
        name = shorter
    return name


def sizes(bench: Bench) -> list[Row]:
    static, dynamic, block = (bench.cost("node", variant) for variant in (STATIC, DYNAMIC, BLOCK))

    def row(what: str, value: float, mark: float) -> Row:
        return Row(what, Figure(value, mark, other_stacks.best(BYTES, what)))

    return [
        row("flash, static mapping", static.flash, 5600),
        row("flash, dynamic mapping", dynamic.flash, 6900),
        row("flash, dynamic mapping, block transfer with CRC", block.flash, 8200),
        row("RAM, static mapping", static.ram, 548),
        row("RAM, dynamic mapping", dynamic.ram, 800),
        row("dictionary, flash for each entry", bench.bytes_per_entry("ref"), 4.0),
        row("dictionary of a servo drive, with limits, for each entry", bench.bytes_per_entry("../eds/cpc-tc1"), 4.5),
    ]


def services(bench: Bench) -> list[tuple[str, Size]]:
    """The size that each service, with its objects, adds to ref.eds with a static mapping."""
    whole = bench.cost("node", STATIC)

    def part(without: str) -> Size:
        rest = bench.cost("node", Variant("ref", static_mapping=True, without=without))
        return Size(whole.flash - rest.flash, whole.ram - rest.ram)

    def more(*added: Entry, **how: bool) -> Size:
        larger = bench.cost("node", Variant("ref", **{"static_mapping": True, **how}, added=added))
        return Size(larger.flash - whole.flash, larger.ram - whole.ram)

    return [
        ("4 RPDOs (1400h, 1600h)", part("14..|16..")),
        ("4 TPDOs (1800h, 1A00h)", part("18..|1A..")),
        ("dynamic mapping of both", more(static_mapping=False)),
        ("SYNC consumer and producer (1005h, 1006h)", part("100[56]")),
        ("SYNC producer (1006h)", part("1006")),
        ("synchronous window (1007h)", more(Entry(0x1007, U32))),
        ("SYNC counter (1019h)", more(Entry(0x1019, U8))),
        ("EMCY producer and history (1003h, 1014h)", part("1003|1014")),
        ("inhibit time of EMCY (1015h)", more(Entry(0x1015, U16))),
        ("heartbeat producer (1017h)", part("1017")),
        ("heartbeat consumer of 4 nodes (1016h)", more(*array(0x1016, U32, 4))),
        ("node guarding (100Ch, 100Dh)", more(Entry(0x100C, U16), Entry(0x100D, U8))),
        ("TIME consumer and producer (1012h)", more(Entry(0x1012, U32, default="0x100"))),
        ("error behaviour (1029h)", more(*array(0x1029, U8, 1))),
        ("SDO block transfer with CRC", Size(*(b - a for a, b in zip(
            astuple(bench.cost("node", DYNAMIC)), astuple(bench.cost("node", BLOCK)))))),
    ]


def objects(bench: Bench) -> list[tuple[str, Size]]:
    """The size that an entry adds."""
    whole = bench.cost("node", STATIC)

    def more(*added: Entry) -> Size:
        larger = bench.cost("node", Variant("ref", static_mapping=True, added=added))
        return Size(larger.flash - whole.flash, larger.ram - whole.ram)

    return [
        ("a VAR behind another one, UNSIGNED32, 0", more(Entry(0x6503, U32))),
        ("a VAR with neighbours that are not there", more(Entry(0x5000, U32))),
        ("a VAR that is a constant of 16 bits", more(Entry(0x6503, U16, "const", "0x1234"))),
        ("an ARRAY of 16 UNSIGNED16", more(*array(0x6503, U16, 16))),
    ]


@dataclass(frozen=True)
class Frame:
    """What is measured of a frame: row of the page, program, its name there, kind of mapping or block transfer, and marks."""

    what: str
    program: str
    name: str
    variant: str
    marks: dict[str, float]


FRAMES = [
    Frame("expedited SDO upload, static mapping", "whole_frame", "upload", "static", {M4: 200, M0: 370}),
    Frame("expedited SDO upload, dynamic mapping", "whole_frame", "upload", "dynamic", {M4: 200, M0: 370}),
    Frame("expedited SDO download of a new value, static mapping", "whole_frame", "download", "static", {M4: 270, M0: 381}),
    Frame("expedited SDO download of a new value, dynamic mapping", "whole_frame", "download", "dynamic", {M4: 300, M0: 420}),
    Frame("segmented SDO upload, per byte", "long_transfers", "segmented-upload", "block", {M4: 20}),
    Frame("segmented SDO download, per byte", "long_transfers", "segmented-download", "block", {M4: 22}),
    Frame("SDO block upload with CRC, per byte", "long_transfers", "block-upload", "block", {}),
    Frame("SDO block download with CRC, per byte", "long_transfers", "block-download", "block", {}),
    Frame("4 RPDOs, SYNC, 4 TPDOs, static mapping", "whole_frame", "sync-cycle", "static", {M4: 680, M0: 1300}),
    Frame("4 RPDOs, SYNC, 4 TPDOs, dynamic mapping", "whole_frame", "sync-cycle", "dynamic", {M4: 950, M0: 2200}),
    Frame("RPDO for the next SYNC", "whole_frame", "rpdo", "static", {M4: 50}),
    Frame("a TPDO of another node", "whole_frame", "foreign", "static", {M4: 60, M0: 110}),
    Frame("`on_time` with nothing due", "whole_frame", "on-time", "static", {M4: 13, M0: 20}),
]
FRAME_VARIANTS = {"static": Variant("bench100", static_mapping=True), "dynamic": Variant("bench100"), "block": BLOCK_SERVER}


def whole_frames(bench: Bench) -> list[FrameRow]:
    """Instructions from the frame that a node receives to those that it sends."""
    def figure(frame: Frame, build: str) -> Figure:
        value = bench.instructions(frame.program, FRAME_VARIANTS[frame.variant], build)[frame.name]
        return Figure(value, frame.marks.get(build), other_stacks.best(build, frame.what))

    return [FrameRow(frame.what, {build: figure(frame, build) for build in COUNTED}) for frame in FRAMES]


def parts(bench: Bench) -> list[tuple[str, float]]:
    """Instructions of parts of the runtime alone, without the node around them."""
    server, block = bench.instructions("sdo_server", SERVER), bench.instructions("sdo_server", BLOCK_SERVER)
    codec = bench.instructions("pdo", Variant("bench100", static_mapping=True))
    return [
        ("look-up of a random entry, 100 indices", bench.instructions("look_up", Variant("bench100"))["look-up"]),
        ("look-up of a random entry, 1000 indices", bench.instructions("look_up", Variant("bench1000"))["look-up"]),
        ("SDO server: expedited upload", server["expedited-upload"]),
        ("SDO server: expedited download", server["expedited-download"]),
        ("SDO server: segmented upload, per byte", server["segmented-upload-per-byte"]),
        ("SDO server: segmented download, per byte", server["segmented-download-per-byte"]),
        ("SDO server: block upload with CRC, per byte", block["block-upload-per-byte"]),
        ("SDO server: block download with CRC, per byte", block["block-download-per-byte"]),
        ("codec: 4 values of 8 bytes into a frame, and its store", codec["tpdo"]),
        ("codec: 4 values of 8 bytes out of a frame", codec["rpdo"]),
    ]


def print_figures(title: str, rows: Iterable[tuple[str, Figure]]) -> None:
    print(f"{title:<57}{'edsc':>8}{'mark':>8}{'':3}ratio to the best other stack")
    for what, figure in rows:
        print(f"{what:<57}{figure.value:8g}{figure.mark_text:>8}{figure.missed_text:3}{figure.ratio_text:>5}  {figure.other_and_stack}")


def table(*columns: str, rows: Iterable[Sequence[object]]) -> str:
    lines = [columns, ["---"] + ["--:"] * (len(columns) - 1), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def tables(bench: Bench) -> dict[str, str]:
    """The tables of whole devices and whole frames, by their names in page.md."""
    return {"sizes": table("bytes", "edsc", "mark", "best other stack", "ratio", rows=[
                (row.what, f"{row.figure.value:g}", row.figure.mark_text, row.figure.other_and_stack, row.figure.ratio_text)
                for row in sizes(bench)]),
            "whole_frames": table("instructions", *(head for build in COUNTED for head in (build, "mark", "best other stack")), rows=[
                (row.what, *(text for figure in row.figures.values()
                             for text in (f"{figure.value:g}", figure.mark_text, figure.other_text)))
                for row in whole_frames(bench)])}


def page(bench: Bench) -> str:
    """docs/footprint.md."""
    def with_bytes(unit: str, rows: Iterable[tuple[str, Size]]) -> str:
        return table(unit, "flash", "RAM", rows=[(what, size.flash, size.ram) for what, size in rows])

    return (HERE / "page.md").read_text(encoding="utf-8").format(
        **tables(bench), rebuilt=other_stacks.rebuilt_text(),
        parts=table("instructions", "edsc", rows=[(what, f"{count:g}") for what, count in parts(bench)]),
        services=with_bytes("service", services(bench)), objects=with_bytes("object", objects(bench)),
        twins="\n".join(twins.table(bench.edsc, bench.runtime)))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("edsc", type=Path)
    parser.add_argument("runtime", type=Path)
    parser.add_argument("--page", action="store_true", help="print docs/footprint.md")
    parser.add_argument("--tables", action="store_true", help="print its first two tables")
    parser.add_argument("--functions", action="store_true", help="list the contents of the images")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments.edsc.resolve(), arguments.runtime.resolve(), Path(folder))
        if arguments.page:
            print(page(bench), end="")
            return
        if arguments.tables:
            print("\n\n".join(tables(bench).values()))
            return
        print_figures("bytes, Cortex-M0+ -Os", [(row.what, row.figure) for row in sizes(bench)])
        frames = whole_frames(bench)
        for build in COUNTED:
            print_figures(f"instructions from frame to frame, Cortex-{build}", [(row.what, row.figures[build]) for row in frames])
        for what, count in parts(bench):
            print(f"{what:<57}{count:8g}")
        if arguments.functions:
            for title, variant in (("static mapping", STATIC), ("dynamic mapping", DYNAMIC), ("block transfer", BLOCK)):
                print(f"\n{title}")
                for size, kind, name in bench.functions("node", variant):
                    print(f"{size:6} {kind} {name}")


if __name__ == "__main__":
    main()
