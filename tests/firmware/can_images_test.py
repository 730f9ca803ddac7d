#!/usr/bin/env python3
"""A node links with the port of each CAN controller, for the core of its chip: without warnings, without a heap, and within the
memory of a small chip. Prints flash and RAM of each image.

    can_images_test.py SOURCE_DIR EDSC

The program is that of examples/can_firmware, which has LSS with a change of the bit rate, acceptance filters and bus status.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, SKIPPED, WARNINGS, those_installed  # noqa: E402

DATA_SHEET, NAMESPACE = "eds/rk5c.eds", "rk5c"
FLASH_LIMIT, RAM_LIMIT = 13_312, 512  # bytes
CODE = ("-std=c++20", "-Os", "-DNDEBUG", "-mthumb", "-ffunction-sections", "-fdata-sections", "-fno-exceptions", "-fno-rtti",
        "-fno-threadsafe-statics")
HEAP = ("malloc", "calloc", "realloc", "free", "_malloc_r", "_calloc_r", "_realloc_r", "_free_r")
LINK = ("-nostartfiles", "-nostdlib", "-Wl,--gc-sections", *(f"-Wl,--wrap={name}" for name in HEAP))
LIBRARIES = ("-Wl,--start-group", "-lc_nano", "-lgcc", "-Wl,--end-group")


@dataclass(frozen=True)
class Chip:
    name: str
    cpu: str
    clock: int      # Hz, of the CAN controller
    port: str       # header
    controller: str  # class
    arguments: str  # of its constructor
    flash: tuple[int, str]  # begin and length
    ram: tuple[int, str]


BXCAN = "*reinterpret_cast<canopen::BxCanRegisters*>(0x4000'6400)"
CHIPS = (
    Chip("STM32F103", "cortex-m3", 36_000_000, "bxcan.hpp", "canopen::BxCan<>", BXCAN,
         (0x0800_0000, "64K"), (0x2000_0000, "20K")),
    Chip("STM32F405", "cortex-m4", 42_000_000, "bxcan.hpp", "canopen::BxCan<>", BXCAN,
         (0x0800_0000, "1024K"), (0x2000_0000, "128K")),
    Chip("STM32G431", "cortex-m4", 24_000_000, "fdcan.hpp", "canopen::FdcanG4",
         "*reinterpret_cast<canopen::FdcanG4Registers*>(0x4000'6400), reinterpret_cast<volatile std::uint32_t*>(0x4000'A400)",
         (0x0800_0000, "128K"), (0x2000_0000, "22K")),
    Chip("STM32H743", "cortex-m7", 80_000_000, "fdcan.hpp", "canopen::FdcanH7",
         "*reinterpret_cast<canopen::FdcanH7Registers*>(0x4000'A000), reinterpret_cast<volatile std::uint32_t*>(0x4000'AC00)",
         (0x0800_0000, "2048K"), (0x2400_0000, "512K")),
)

CAN_HEADER = """#pragma once
#include <canopen/port/{port}>
#include <cstdint>
namespace board {{
using Can = {controller};
inline constexpr std::uint32_t can_clock = {clock};
inline Can make_can() {{ return Can{{{arguments}}}; }}
}}
"""
MEMORY = "MEMORY {{ flash (rx) : ORIGIN = {flash[0]}, LENGTH = {flash[1]}  ram (rwx) : ORIGIN = {ram[0]}, LENGTH = {ram[1]} }}\n"


def link(chip: Chip, source: Path, generated: Path, folder: Path) -> tuple[Path, str]:
    """Returns the image, and the messages of the compiler if it fails."""
    (folder / "can.hpp").write_text(CAN_HEADER.format(**vars(chip)), encoding="utf-8")
    (folder / "memory.ld").write_text(MEMORY.format(**vars(chip)), encoding="utf-8")
    boards = source / "cmake/boards"
    image = folder / "image.elf"
    result = subprocess.run(
        [ARM_GCC.name, f"-mcpu={chip.cpu}", *CODE, *WARNINGS, f"-I{source / 'runtime/include'}", f"-I{boards}", f"-I{folder}",
         f"-I{generated}", f"-DEDSC_DEVICE={NAMESPACE}::Device", f"-DEDSC_DEVICE_HEADER=<{NAMESPACE}/device.hpp>",
         boards / "startup.cpp", source / "tests/firmware/can_board.cpp", source / "examples/can_firmware/main.cpp",
         *LINK, f"-L{folder}", f"-T{boards / 'sections.ld'}", *LIBRARIES, "-o", image],
        capture_output=True, text=True, timeout=900)
    return image, result.stderr if result.returncode != 0 else ""


def main() -> int:
    source, edsc = (Path(argument).resolve() for argument in sys.argv[1:3])
    if not those_installed([ARM_GCC]):
        return SKIPPED
    problems: list[str] = []
    with tempfile.TemporaryDirectory() as temporary:
        generated = Path(temporary)
        subprocess.run([edsc, "generate", source / DATA_SHEET, "-o", generated, "--name", NAMESPACE], check=True)
        for chip in CHIPS:
            folder = generated / chip.name
            folder.mkdir()
            image, message = link(chip, source, generated, folder)
            if message:
                problems.append(f"{chip.name}: {message}")
                continue
            size = subprocess.run(["arm-none-eabi-size", image], check=True, capture_output=True, text=True).stdout
            text, data, bss = (int(number) for number in size.splitlines()[1].split()[:3])
            print(f"{chip.name}, {chip.cpu}, {chip.port}: {text + data} bytes of flash, {data + bss} of RAM")
            if text + data > FLASH_LIMIT or data + bss > RAM_LIMIT:
                problems.append(f"{chip.name}: more than {FLASH_LIMIT} bytes of flash or {RAM_LIMIT} of RAM")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
