#!/usr/bin/env python3
"""What the SDO server alone costs, with and without block transfer.

    measure.py EDSC RUNTIME_INCLUDE

Flash and RAM in bytes on a Cortex-M0+ (-Os), without those of a program that has no server: the dictionary bench100.eds
and the look-up are in them. Instructions on a Cortex-M4 (-O2), counted by QEMU: the loop that asks and the eight bytes
that are sent are in them.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
FLAGS = ["-std=c++20", "-mthumb", "-ffunction-sections", "-fdata-sections", "-fno-exceptions", "-fno-rtti",
         "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wno-register", "--specs=nano.specs", "-nostartfiles",
         "-Wl,--gc-sections", f"-T{HERE / 'firmware.ld'}"]
SMALL = ["-mcpu=cortex-m0plus", "-Os"]
FAST = ["-mcpu=cortex-m4", "-O2", "-DCOUNT"]
SERVERS = {"without block transfer": ["-DWITH_SERVER"], "with block transfer": ["-DWITH_SERVER", "-DWITH_BLOCK"]}


def build(program: Path, include: list[str], flags: list[str]) -> Path:
    subprocess.run(["arm-none-eabi-g++", *FLAGS, *flags, *include, HERE / "firmware.cpp", "-o", program], check=True)
    return program


def size_of(program: Path) -> tuple[int, int]:
    """Flash and RAM."""
    output = subprocess.run(["arm-none-eabi-size", program], check=True, capture_output=True, text=True).stdout
    text, data, bss = (int(word) for word in output.splitlines()[1].split()[:3])
    return text + data, data + bss


def instructions(program: Path) -> str:
    return subprocess.run(["qemu-system-arm", "-M", "mps2-an386", "-icount", "shift=0", "-semihosting", "-nographic",
                           "-kernel", program], check=False, capture_output=True, text=True, timeout=60,
                          stdin=subprocess.DEVNULL).stderr


def main() -> None:
    edsc, runtime = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        subprocess.run([edsc, "generate", HERE.parent / "bench100.eds", "-o", out, "--name", "device"], check=True,
                       capture_output=True)
        include = [f"-I{runtime}", f"-I{out}"]
        empty = size_of(build(out / "empty.elf", include, SMALL))
        for name, flags in SERVERS.items():
            flash, ram = size_of(build(out / "small.elf", include, SMALL + flags))
            print(f"{name}\n  flash {flash - empty[0]}\n  ram {ram - empty[1]}")
            for line in instructions(build(out / "fast.elf", include, FAST + flags)).splitlines():
                print(f"  {line}")


if __name__ == "__main__":
    main()
