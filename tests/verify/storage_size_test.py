#!/usr/bin/env python3
"""A node without storage has none of its code in the image.

    storage_size_test.py SOURCE_DIR GENERATED_DIR

Builds a node of the same device for Cortex-M0+ at -Os without storage and with two pages of flash. Prints flash and RAM of
both.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, those_installed  # noqa: E402

NODE = """
#include <canopen/node.hpp>
#include <stored_device/device.hpp>

extern "C" bool can_send(const canopen::Frame&);
extern "C" bool can_receive(canopen::Frame&);
extern "C" std::uint32_t microseconds();

struct Can {
  bool send(const canopen::Frame& frame) { return can_send(frame); }
};
Can can;

#ifdef STORED
#include <canopen/flash_storage.hpp>

extern "C" bool flash_erase(std::uint8_t page);
extern "C" bool flash_write(std::uint8_t page, std::uint32_t offset, const std::uint8_t* words, std::size_t size);
extern "C" bool flash_read(std::uint8_t page, std::uint32_t offset, std::uint8_t* to, std::size_t size);

struct Flash {
  static constexpr std::uint32_t page_size = 2048;
  static constexpr std::uint32_t word_size = 8;
  bool erase(std::uint8_t page) { return flash_erase(page); }
  bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    return flash_write(page, offset, words.data(), words.size());
  }
  bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) {
    return flash_read(page, offset, to.data(), to.size());
  }
};
Flash flash;
constinit canopen::FlashStorage storage{flash};
constinit auto node =
    canopen::make_node<stored_device::Device>(can, canopen::NodeId{5}, canopen::stored_in(storage));
#else
constinit auto node = canopen::make_node<stored_device::Device>(can, canopen::NodeId{5});
#endif

int main() {
  node.start(canopen::TimePoint{canopen::Duration{microseconds()}});
  for (;;) {
    canopen::Frame frame;
    const canopen::TimePoint now{canopen::Duration{microseconds()}};
    if (can_receive(frame)) node.on_frame(frame, now);
    node.on_time(now);
  }
}
"""

# What only a node with storage needs, as its symbols are named.
STORAGE = ("ParameterStorage", "FlashStorage", "ParameterLayout")


def build(name: str, include: Path, runtime: Path, folder: Path, *extra: str) -> Path:
    source = folder / "node.cpp"
    source.write_text(NODE)
    image = folder / f"{name}.o"
    subprocess.run(
        ["arm-none-eabi-g++", "-std=c++20", "-Os", "-mcpu=cortex-m0plus", "-mthumb", "-fno-exceptions", "-fno-rtti",
         "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wpedantic", "-Werror",
         "-ffunction-sections", "-fdata-sections", f"-I{runtime}", f"-I{include}", *extra, "-c", source, "-o", image],
        check=True)
    return image


def sizes(image: Path) -> tuple[int, int]:
    """Flash and RAM in bytes."""
    row = subprocess.run(["arm-none-eabi-size", image], check=True, capture_output=True, text=True).stdout.splitlines()[1]
    text, data, bss = (int(number) for number in row.split()[:3])
    return text + data, data + bss


def storage_symbols(image: Path) -> set[str]:
    names = subprocess.run(["arm-none-eabi-nm", "-C", image], check=True, capture_output=True, text=True).stdout
    return {word for word in STORAGE if word in names}


def main() -> int:
    source_dir, generated_dir = (Path(argument) for argument in sys.argv[1:3])
    if not those_installed([ARM_GCC]):
        print("skipped: arm-none-eabi-g++ is not installed")
        return 77
    runtime = source_dir / "runtime/include"
    with tempfile.TemporaryDirectory() as temporary:
        without = build("without", generated_dir, runtime, Path(temporary))
        stored = build("stored", generated_dir, runtime, Path(temporary), "-DSTORED")
        without_size, stored_size = sizes(without), sizes(stored)
        print(f"without storage: {without_size[0]} bytes of flash, {without_size[1]} of RAM")
        print(f"with two pages:  {stored_size[0]} bytes of flash, {stored_size[1]} of RAM")
        found = storage_symbols(without)
        if found:
            print(f"the image without storage has {', '.join(sorted(found))}")
        missing = set(STORAGE) - storage_symbols(stored)
        if missing:
            print(f"the image with storage lacks {', '.join(sorted(missing))}: this test looks for the wrong names")
        smaller = without_size[0] < stored_size[0] and without_size[1] < stored_size[1]
        if not smaller:
            print("no storage saves nothing")
        return 0 if smaller and not found and not missing else 1


if __name__ == "__main__":
    sys.exit(main())
