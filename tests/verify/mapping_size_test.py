#!/usr/bin/env python3
"""A device with static mapping has no code for remapping in its image.

    mapping_size_test.py SOURCE_DIR DYNAMIC_DIR STATIC_DIR

Builds a node of the same data sheet twice for Cortex-M0+ at -Os: with its mapping parameters in RAM, from DYNAMIC_DIR,
and as constants, from STATIC_DIR. Prints flash and RAM of both.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, compile_only, those_installed  # noqa: E402

NODE = """
#include <canopen/node.hpp>
#include <{name}/device.hpp>

extern "C" bool can_send(const canopen::Frame&);
extern "C" bool can_receive(canopen::Frame&);
extern "C" std::uint32_t microseconds();

struct Can {{
  bool send(const canopen::Frame& frame) {{ return can_send(frame); }}
}};

Can can;
constinit canopen::Node<{name}::Device, Can> node{{can, canopen::NodeId{{5}}}};

int main() {{
  node.start(canopen::TimePoint{{canopen::Duration{{microseconds()}}}});
  for (;;) {{
    canopen::Frame frame;
    const canopen::TimePoint now{{canopen::Duration{{microseconds()}}}};
    if (can_receive(frame)) node.on_frame(frame, now);
    node.on_time(now);
  }}
}}
"""

# What only a device with dynamic mapping needs, as the symbols of its functions are named.
REMAPPING = ("can_be_mapped", "MappedPlaces", "pack_mapped", "take_mapped")


def build(name: str, include: Path, runtime: Path, folder: Path) -> Path:
    source = folder / f"{name}.cpp"
    source.write_text(NODE.format(name=name))
    image = folder / f"{name}.o"
    subprocess.run(
        ["arm-none-eabi-g++", "-std=c++20", "-Os", "-mcpu=cortex-m0plus", "-mthumb", "-fno-exceptions", "-fno-rtti",
         "-ffunction-sections", "-fdata-sections", f"-I{runtime}", f"-I{include}", "-c", source, "-o", image],
        check=True)
    return image


def sizes(image: Path) -> tuple[int, int]:
    """Flash and RAM in bytes."""
    row = subprocess.run(["arm-none-eabi-size", image], check=True, capture_output=True, text=True).stdout.splitlines()[1]
    text, data, bss = (int(number) for number in row.split()[:3])
    return text + data, data + bss


def remapping_symbols(image: Path) -> set[str]:
    names = subprocess.run(["arm-none-eabi-nm", "-C", image], check=True, capture_output=True, text=True).stdout
    return {word for word in REMAPPING if any(word in line for line in names.splitlines())}


def main() -> int:
    source_dir, dynamic_dir, static_dir = (Path(argument) for argument in sys.argv[1:4])
    if not those_installed([ARM_GCC]):
        print("skipped: arm-none-eabi-g++ is not installed")
        return 77
    runtime = source_dir / "runtime/include"
    with tempfile.TemporaryDirectory() as temporary:
        dynamic = build("pdo_device", dynamic_dir, runtime, Path(temporary))
        static = build("static_pdo_device", static_dir, runtime, Path(temporary))
        dynamic_size, static_size = sizes(dynamic), sizes(static)
        print(f"dynamic mapping: {dynamic_size[0]} bytes of flash, {dynamic_size[1]} of RAM")
        print(f"static mapping:  {static_size[0]} bytes of flash, {static_size[1]} of RAM")
        found = remapping_symbols(static)
        if found:
            print(f"the image with static mapping has {', '.join(sorted(found))}")
        missing = set(REMAPPING) - remapping_symbols(dynamic)
        if missing:
            print(f"the image with dynamic mapping lacks {', '.join(sorted(missing))}: this test looks for the wrong names")
        smaller = static_size[0] < dynamic_size[0] and static_size[1] < dynamic_size[1]
        if not smaller:
            print("static mapping saves nothing")
        return 0 if smaller and not found and not missing else 1


if __name__ == "__main__":
    sys.exit(main())
