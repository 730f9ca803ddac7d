#!/usr/bin/env python3
"""Files of one program that are compiled for size and for speed are not linked: they disagree on the layout of a node.

    optimization_goals_test.py SOURCE_DIR
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, CLANG, GCC, SKIPPED, Compiler, those_installed  # noqa: E402

# The file with the node, and a file that uses it.
NODE = """
#include <canopen/node.hpp>
#include <can_2057c/device.hpp>
struct Bus { bool send(const canopen::Frame&) { return true; } };
Bus bus;
using Parts = canopen::Composition<can_2057c::Device, canopen::without<canopen::part::storage>>;
canopen::Node<Parts, Bus> node{bus, canopen::NodeId{5}};
"""
USER = """
#include <canopen/node.hpp>
#include <can_2057c/device.hpp>
struct Bus { bool send(const canopen::Frame&) { return true; } };
using Parts = canopen::Composition<can_2057c::Device, canopen::without<canopen::part::storage>>;
extern canopen::Node<Parts, Bus> node;
int main() { node.on_time(canopen::TimePoint{}); }
"""
SYMBOL = "canopen_optimization_goal"
EXPLANATION = "must be compiled alike"


@dataclass(frozen=True)
class Way:
    """A way to link, and the text with which it reports files of different goals; empty: it does not report them."""
    compiler: Compiler
    flags: tuple[str, ...]
    report: str

    @property
    def name(self) -> str:
        return " ".join((self.compiler.name, *self.flags))


# Clang without link-time optimization does not report it: base/same_in_all_files.hpp.
ARM_FLAGS = ("-mthumb", "--specs=nosys.specs")
WAYS = (
    Way(GCC, (), SYMBOL),
    Way(GCC, ("-flto",), EXPLANATION),
    Way(ARM_GCC, ARM_FLAGS, SYMBOL),
    Way(ARM_GCC, (*ARM_FLAGS, "-flto"), EXPLANATION),
    Way(CLANG, (), ""),
    Way(CLANG, ("-flto",), EXPLANATION),
)
# Goals of two files; whether they are the same.
PAIRS = (("-O2", "-Os", False), ("-Os", "-O2", False), ("-Os", "-O0", False), ("-O2", "-O0", True),
         ("-O3", "-O2", True), ("-Os", "-Os", True))


def compiled(compiler: Compiler, flags: tuple[str, ...], goal: str, source: Path, include: tuple[Path, ...]) -> Path:
    output = source.with_name(f"{source.stem}{goal}.o")
    subprocess.run([*compiler.command, "-std=c++20", *flags, goal, *(f"-I{folder}" for folder in include), "-c",
                    str(source), "-o", str(output)], check=True, timeout=600)
    return output


def linked(compiler: Compiler, flags: tuple[str, ...], objects: list[Path], folder: Path) -> str:
    """Returns what the linker reports; empty if it has written the program."""
    output = folder / "program"
    run = subprocess.run([*compiler.command, *flags, *map(str, objects), "-o", str(output)], capture_output=True,
                         text=True, timeout=600)
    return "" if run.returncode == 0 else run.stderr


def problems_of(way: Way, folder: Path, include: tuple[Path, ...]) -> list[str]:
    user, other = folder / "user.cpp", folder / "other.cpp"
    user.write_text("#include <canopen/base/optimization.hpp>\nint main() { return 0; }\n")
    other.write_text("#include <canopen/base/optimization.hpp>\nint other() { return 0; }\n")
    problems = []
    for one, two, same in PAIRS:
        report = linked(way.compiler, way.flags, [compiled(way.compiler, way.flags, one, user, include),
                                                  compiled(way.compiler, way.flags, two, other, include)], folder)
        if same and report:
            problems.append(f"{way.name}: {one} and {two} are not linked:\n{report}")
        if not same and way.report and way.report not in report:
            problems.append(f"{way.name}: {one} and {two}: `{way.report}` is not in the report:\n{report}")
    return problems


def problems_of_node(folder: Path, include: tuple[Path, ...]) -> list[str]:
    """The same for a node that two files use."""
    node, user = folder / "node.cpp", folder / "node_user.cpp"
    node.write_text(NODE)
    user.write_text(USER)
    objects = {goal: compiled(GCC, (), goal, user, include) for goal in ("-O1", "-Os")}
    node_object = compiled(GCC, (), "-Os", node, include)
    problems = []
    if SYMBOL not in linked(GCC, (), [node_object, objects["-O1"]], folder):
        problems.append("g++: a node compiled with -Os is used by a file compiled with -O1")
    if report := linked(GCC, (), [node_object, objects["-Os"]], folder):
        problems.append(f"g++: two files compiled with -Os are not linked:\n{report}")
    return problems


def main() -> int:
    source_dir = Path(sys.argv[1]).resolve()
    include = (source_dir / "runtime/include", source_dir / "generated")
    compilers = those_installed((GCC, CLANG, ARM_GCC))
    if not compilers:
        return SKIPPED
    problems = []
    with tempfile.TemporaryDirectory() as scratch:
        for way in WAYS:
            if way.compiler in compilers:
                problems += problems_of(way, Path(scratch), include)
        if GCC in compilers:
            problems += problems_of_node(Path(scratch), include)
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
