#!/usr/bin/env python3
"""The image of a device does not include services that the device does not have.

    image_test.py SOURCE_DIR BUILD_DIR

Builds complete nodes for Cortex-M0+ at -Os with and without a service, from the code that edsc has generated below BUILD_DIR.
Prints flash and RAM of both.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, SKIPPED, those_installed  # noqa: E402
from support.cortex_m0 import Image, build, only_in  # noqa: E402


@dataclass(frozen=True)
class Case:
    service: str
    having: tuple[str, ...]   # device and flags
    without: tuple[str, ...]
    symbols: tuple[str, ...]  # parts of the names of functions and tables that only the service needs


CASES = (
    Case("dynamic mapping", ("pdo_device",), ("static_pdo_device",),
         ("can_be_mapped", "MappedPlaces", "pack_mapped")),
    Case("storage", ("stored_device", "-DSTORED"), ("stored_device",),
         ("ParameterStorage", "FlashStorage", "ParameterLayout")),
)


def image_of(device: str, *flags: str, source_dir: Path, build_dir: Path, folder: Path) -> Image:
    include = (source_dir / "runtime/include", source_dir / "tests", build_dir / "edsc" / device)
    return build(source_dir / "tests/verify/image/node.cpp", include, folder, f"-DDEVICE={device}::Device",
                 f"-DDEVICE_HEADER=<{device}/device.hpp>", *flags)


def main() -> int:
    source_dir, build_dir = (Path(argument).resolve() for argument in sys.argv[1:3])
    if not those_installed([ARM_GCC]):
        return SKIPPED
    problems: list[str] = []
    with tempfile.TemporaryDirectory() as temporary:
        where = {"source_dir": source_dir, "build_dir": build_dir, "folder": Path(temporary)}
        for case in CASES:
            having, without = image_of(*case.having, **where), image_of(*case.without, **where)
            print(f"with {case.service}: {having.flash} bytes of flash, {having.ram} of RAM; "
                  f"without: {without.flash} and {without.ram}")
            problems += only_in(having, without, case.symbols, case.service)
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
