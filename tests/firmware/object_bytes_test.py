#!/usr/bin/env python3
"""The flash and RAM of an object: images of an EDS with and without it differ by the size in the report.

    object_bytes_test.py EDSC

Flash grows by the bytes of the object itself, the part that all objects share, and code; at most UNEXPLAINED bytes are none of
these. RAM is exact.
"""

from __future__ import annotations

import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from project import SOURCE_DIR, Project

sys.path.insert(0, str(SOURCE_DIR / "cmake"))
from firmware_report import Dictionary, Parts, read_image  # noqa: E402

BOARDS = {"microbit": "Cortex-M0+", "mps2-an386": "Cortex-M4"}
UNEXPLAINED = 4  # bytes between symbols
U8, U16, U32, STRING = 5, 6, 7, 9
SECTION = """[{section}]
ParameterName=Added {section}
ObjectType=0x7
DataType=0x{type:04X}
AccessType={access}
DefaultValue={default}
PDOMapping={mappable}
{more}
"""


def entry(section: str, kind: int, access: str = "rw", default: object = 0, mappable: int = 0, more: str = "") -> str:
    return SECTION.format(section=section, type=kind, access=access, default=default, mappable=mappable, more=more)


def parts(index: str, object_type: int, *kinds: int) -> str:
    """An ARRAY (8) or RECORD (9)."""
    head = f"[{index}]\nParameterName=Added {index}\nObjectType=0x{object_type}\nSubNumber={len(kinds) + 1}\n\n"
    return head + entry(f"{index}sub0", U8, "const", len(kinds)) + "".join(
        entry(f"{index}sub{sub}", kind) for sub, kind in enumerate(kinds, 1))


@dataclass(frozen=True)
class Variant:
    name: str
    index: str
    text: str
    flash: int  # minimum bytes of the object itself: one word in the tables
    ram: int    # bytes of its value


# REMOVED is an object of the device; all others are added to it.
REMOVED = Variant("removed u16", "2008", entry("2008", U16, default=7), 6, 2)
PRESENT = (REMOVED, Variant("", "2030", parts("2030", 8, U16, U16), 0, 0), Variant("", "2031", parts("2031", 9, U8, U16), 0, 0),
           Variant("", "2032", entry("2032", STRING, "rw", "abc"), 0, 0))
ADDED = (
    Variant("u8", "2009", entry("2009", U8), 4, 1),
    Variant("u32", "2009", entry("2009", U32), 4, 4),
    Variant("u32 with a default", "2009", entry("2009", U32, default=5), 8, 4),
    Variant("const u16", "2009", entry("2009", U16, "const", 500), 4, 0),
    Variant("const u32", "2009", entry("2009", U32, "const", "0x12345678"), 8, 0),
    Variant("u16 with limits", "2009", entry("2009", U16, more="LowLimit=0\nHighLimit=100"), 16, 2),
    Variant("mappable u32", "2009", entry("2009", U32, "rww", mappable=1), 4, 4),
    Variant("string", "2009", entry("2009", STRING, "const", "a longer text"), 4 + 2 + 13, 0),
    Variant("array of 4 u16", "2009", parts("2009", 8, U16, U16, U16, U16), 4, 8),
    Variant("record u8, u16, u32", "2009", parts("2009", 9, U8, U16, U32), 16, 8),
    Variant("far away", "5000", entry("5000", U32), 4, 4),
)


def sheet(variants: list[Variant]) -> str:
    """The EDS of the pump of the examples with these objects."""
    text = (SOURCE_DIR / "examples/first_device/pump.eds").read_text(encoding="utf-8")
    indices = sorted(["2000", "2001", *(variant.index for variant in variants)])
    listed = [f"SupportedObjects={len(indices)}", *(f"{number}=0x{index}" for number, index in enumerate(indices, 1))]
    text, count = re.subn(r"(\[ManufacturerObjects\]\n)(?:.+\n)+", lambda match: match[1] + "\n".join(listed) + "\n", text)
    assert count == 1
    return text + "\n" + "".join(variant.text for variant in variants)


@dataclass(frozen=True)
class Cost:
    flash: Parts
    ram: Parts


def cost(project: Project, target: str, namespace: str) -> Cost:
    image = read_image(project.build_dir / f"{target}.elf", "arm-none-eabi-")
    header = project.build_dir / f"edsc/{target}_dictionary/{namespace}/dictionary.hpp"
    dictionary = Dictionary(header.read_text(encoding="utf-8"))
    return Cost(dictionary.flash(image), dictionary.ram(image))


def problems(variant: Variant, less: Cost, more: Cost) -> list[str]:
    """Problems of the object that `more` has and `less` does not have."""
    grown = more.flash.total - less.flash.total
    own = more.flash.objects[variant.index]
    others = more.flash.objects.total() - own - less.flash.objects.total()
    shared = more.flash.shared.total() - less.flash.shared.total()
    code = more.flash.code - less.flash.code
    unexplained = grown - own - others - shared - code
    ram = more.ram.total - less.ram.total
    own_ram = more.ram.objects[variant.index]
    shared_ram = more.ram.shared.total() - less.ram.shared.total()
    print(f"  {variant.name:22} flash {grown:+4} = object {own:3}, shared {shared:+3}, moved {others:+3}, code {code:+4}, "
          f"between {unexplained:+2}; RAM {ram:+3} = object {own_ram:2}, alignment {shared_ram:+2}")
    found = []
    if abs(unexplained) > UNEXPLAINED:
        found.append(f"{unexplained} of {grown} bytes of flash are not explained")
    if ram != own_ram + shared_ram:
        found.append(f"RAM grows by {ram}, not by {own_ram} + {shared_ram}")
    if own < variant.flash or own_ram != variant.ram:
        found.append(f"the report has {own} and {own_ram} bytes of it, not {variant.flash} or more and {variant.ram}")
    if variant.index in less.flash.objects:
        found.append("the report has it in the image without it")
    return [f"{variant.name}: {problem}" for problem in found]


def main() -> int:
    with tempfile.TemporaryDirectory(prefix="edsc-objects-") as folder:
        project = Project(Path(folder), Path(sys.argv[1]).resolve())
        sheets = {"base": list(PRESENT), "without": [variant for variant in PRESENT if variant is not REMOVED],
                  **{f"with{number}": [*PRESENT, variant] for number, variant in enumerate(ADDED)}}
        lines = []
        for name, variants in sheets.items():
            (project.folder / f"{name}.eds").write_text(sheet(variants), encoding="utf-8")
            lines += [f'edsc_add_firmware({name}_{board} EDS {name}.eds NAMESPACE pump BOARD {board} NODE_ID 5 '
                      f'SOURCES "{SOURCE_DIR}/examples/firmware/main.cpp")' for board in BOARDS]
        project.configure("\n".join(lines))
        built = project.build()
        if built.returncode != 0:
            print(built.stdout[-5000:])
            return 1
        failures = []
        for board, core in BOARDS.items():
            print(f"{core}:")
            costs = {name: cost(project, f"{name}_{board}", "pump") for name in sheets}
            failures += [f"{core}, {problem}" for problem in problems(REMOVED, costs["without"], costs["base"])]
            for number, variant in enumerate(ADDED):
                failures += [f"{core}, {problem}" for problem in problems(variant, costs["base"], costs[f"with{number}"])]
    print("\n".join(failures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
