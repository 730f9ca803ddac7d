#!/usr/bin/env python3
"""Codecs of PdoLayout need as many instructions as hand-written ones.

    codec_instructions_test.py SOURCE_DIR

Compiles codec/typed.cpp and codec/by_hand.cpp at -O2 for x86-64 and for a Cortex-M4 and counts the instructions of each
function. With g++, layouts of whole bytes need no more than by hand, those that mix bits and bytes at most 1.2 times as
many. The results of clang are only printed.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import SKIPPED, Compiler, those_installed  # noqa: E402

WHOLE_BYTES = ("words", "drive", "mixed", "bytes", "triples", "real")
MOST_OF_BITS = 1.2

FUNCTION = re.compile(r"^[0-9a-f]+ <(?P<name>.*)>:$")
INSTRUCTION = re.compile(r"^ +[0-9a-f]+:\t(?P<text>[^\t ]+)")
PADDING = re.compile(r"nop[wl]?|nop\.[nw]|cs|data16|xchg|endbr64|\.word|\.short")  # and constants after a function


@dataclass(frozen=True)
class Target:
    name: str
    compiler: Compiler
    objdump: str
    checked: bool


TARGETS = (
    Target("x86-64, g++", Compiler(("g++",)), "objdump", True),
    Target("Cortex-M4, g++", Compiler(("arm-none-eabi-g++", "-mcpu=cortex-m4", "-mthumb")), "arm-none-eabi-objdump", True),
    Target("x86-64, clang", Compiler(("clang++",)), "objdump", False),
)


def compiled(target: Target, source: Path, runtime: Path, folder: Path) -> Path:
    made = folder / f"{source.stem}.o"
    subprocess.run([*target.compiler.command, "-std=c++20", "-O2", "-fno-exceptions", "-fno-rtti", f"-I{runtime}", "-c",
                    source, "-o", made], check=True, timeout=600)
    return made


def instructions(objdump: str, made: Path) -> dict[str, int]:
    """The number of instructions of each function, without the padding after it."""
    listing = subprocess.run([objdump, "-d", "--demangle", "--no-show-raw-insn", made], check=True, capture_output=True,
                             text=True).stdout
    counts: dict[str, int] = {}
    name = ""
    for line in listing.splitlines():
        if function := FUNCTION.match(line):
            name = function["name"].split("(")[0].rsplit("::", 1)[-1]
        elif (instruction := INSTRUCTION.match(line)) and not PADDING.fullmatch(instruction["text"]):
            counts[name] = counts.get(name, 0) + 1
    return counts


def main() -> int:
    source_dir = Path(sys.argv[1]).resolve()
    folder = source_dir / "tests/verify/codec"
    runtime = source_dir / "runtime/include"
    installed = those_installed(target.compiler for target in TARGETS)
    problems = []
    columns: list[tuple[Target, dict[str, int], dict[str, int]]] = []
    for target in TARGETS:
        if target.compiler not in installed:
            continue
        with tempfile.TemporaryDirectory() as temporary:
            typed, by_hand = (instructions(target.objdump, compiled(target, folder / source, runtime, Path(temporary)))
                              for source in ("typed.cpp", "by_hand.cpp"))
        if not typed or typed.keys() != by_hand.keys():
            problems.append(f"{target.name}: not the same functions: {sorted(typed.keys() ^ by_hand.keys())}")
        columns.append((target, typed, by_hand))

    print(f"{'':18}" + "".join(f"{target.name:>22}" for target, *_ in columns))
    for name in columns[0][1] if columns else ():
        row = f"{name:18}"
        for target, typed, by_hand in columns:
            row += f"{typed[name]:>14} :{by_hand[name]:>5}  "
            most = by_hand[name] * (1 if name.split("_")[1] in WHOLE_BYTES else MOST_OF_BITS)
            if target.checked and typed[name] > most:
                problems.append(f"{target.name}: {name} needs {typed[name]} instructions, by hand {by_hand[name]}")
        print(row.rstrip())
    print("\n".join(problems))
    print(f"{len(columns)} targets, {len(problems)} problems (typed : by hand)")
    return 1 if problems else 0 if any(target.checked for target, *_ in columns) else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
