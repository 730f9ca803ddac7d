"""Images for Cortex-M0+ at -Os: their sizes and symbols."""

from __future__ import annotations

import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from support.compilers import WARNINGS

COMMAND = (
    "arm-none-eabi-g++", "-std=c++20", "-Os", "-mcpu=cortex-m0plus", "-mthumb", "-fno-exceptions", "-fno-rtti", *WARNINGS,
    "-ffunction-sections", "-fdata-sections",
)


@dataclass(frozen=True)
class Image:
    flash: int  # bytes
    ram: int
    symbols: str

    def has(self, words: Iterable[str]) -> set[str]:
        """Returns those of the words that are part of the name of a symbol."""
        return {word for word in words if word in self.symbols}


def build(source: Path, include: Sequence[Path], folder: Path, *extra: str) -> Image:
    """Compiles one source; it is not linked, so that external code is not counted."""
    made = folder / "image.o"
    folders = [f"-I{path}" for path in include]
    subprocess.run([*COMMAND, *folders, *extra, "-c", source, "-o", made], check=True, timeout=600)
    text, data, bss = (int(number) for number in output("arm-none-eabi-size", made).splitlines()[1].split()[:3])
    return Image(text + data, data + bss, output("arm-none-eabi-nm", "-C", made))


def output(*command: str | Path) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def only_in(one: Image, other: Image, words: Sequence[str], what: str) -> list[str]:
    """Returns problems if `words` are not in `one` or are in `other`, or if `other` is not the smaller one."""
    problems = []
    if found := other.has(words):
        problems.append(f"the image without {what} has {', '.join(sorted(found))}")
    if missing := set(words) - one.has(words):
        problems.append(f"the image with {what} lacks {', '.join(sorted(missing))}: these are the wrong names")
    if other.flash >= one.flash or other.ram >= one.ram:
        problems.append(f"without {what} nothing is saved")
    return problems
