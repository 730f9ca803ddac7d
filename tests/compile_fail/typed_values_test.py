#!/usr/bin/env python3
"""No way to pass a value to an object converts it silently.

    typed_values_test.py SOURCE_DIR GENERATED_DIR [WAY [KIND]]      GENERATED_DIR has a folder for each device

Each row of WAYS is a statement that passes a value, and each row of KINDS is a wrong value for an object. None of them
compiles as a statement: the compiler rejects the value, or it has a result that must be used. The message has at most 12
lines and the name of the object. A value that is right compiles.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import (CLANG, GCC, SKIPPED, Compiler, compile_only, in_parallel, precompiled,  # noqa: E402
                               those_installed)

MOST_LINES = 12
UNUSED_IS_FINE = ("-Wno-unused-variable", "-Wno-unused-but-set-variable", "-Wno-unused-parameter")
COMMON_HEADERS = """#include <canopen/sdo/remote_node.hpp>
#include <canopen/node.hpp>
#include <canopen/node/locked.hpp>
#include <canopen/host/blocking_sdo.hpp>
#include <every_type/device.hpp>
#include "support/omitting.hpp"
"""
SOURCE = """namespace od = every_type::od;
using Device = every_type::Device;
struct Bus {{
  bool send(const canopen::Frame&) {{ return true; }}
  std::optional<canopen::Frame> receive(canopen::Duration);
  canopen::TimePoint now();
}};
struct Lock {{
  void lock() {{}}
  void unlock() {{}}
}};
enum Setting : std::uint16_t {{ setting = 7 }};
enum class Mode : std::uint16_t {{ on = 7 }};
using O = {object};
using Node = bench::NodeOf<Device, Bus>;
using Box = canopen::Mailbox<O>;
void pass(Node& node, canopen::Locked<Node, Lock>& locked, Box& box, canopen::RemoteNode<Device, Bus>& remote,
          canopen::BlockingObjects<Device, canopen::BlockingSdo<Bus>>& objects, canopen::TimePoint now,
          canopen::Frame& frame, Bus& bus) {{
  {declaration}
  {statement}
}}
"""


@dataclass(frozen=True)
class Kind:
    name: str
    object: str
    declaration: str
    value: str


LIMITED, PLAIN, TEXT, REAL = ("od::unsigned16_value", "od::access_rw", "od::visible_string_value", "od::real32_value")
NUMBERS = (
    Kind("wider variable", PLAIN, "std::uint32_t value = 65636;", "value"),
    Kind("wider constant variable", PLAIN, "const std::uint32_t value = frame.id;", "value"),
    Kind("wider constant", PLAIN, "", "70000"),
    Kind("signed variable", PLAIN, "std::int16_t value = -1;", "value"),
    Kind("negative constant", PLAIN, "", "-1"),
    Kind("variable with a fraction", PLAIN, "double value = 24.9;", "value"),
    Kind("constant with a fraction", PLAIN, "", "24.9"),
    Kind("constant above the limit", LIMITED, "", "0xFFFF"),
    Kind("enumerator", PLAIN, "", "setting"),
    Kind("enumerator of a class", PLAIN, "", "Mode::on"),
    Kind("bool", PLAIN, "", "true"),
    Kind("text", PLAIN, "", '"a"'),
    Kind("NaN", REAL, "", "std::numeric_limits<double>::quiet_NaN()"),
    Kind("beyond a REAL32", REAL, "", "1e300"),
)
CHECKED = (Kind("limited variable", LIMITED, "std::uint16_t value = frame.size;", "value"),
           Kind("NaN in a variable", REAL, "float value = std::numeric_limits<float>::quiet_NaN();", "value"))
TEXTS = (Kind("long literal", TEXT, "", '"longer"'), Kind("text of unknown length", TEXT, "std::string_view value;", "value"),
         Kind("number for a text", TEXT, "", "5"))

# The name, the statement, and the kinds of values that it can be given.
NODE, CODEC = (*NUMBERS, *CHECKED, *TEXTS), NUMBERS
WAYS = {
    "node, tag": ("node.set(O{{}}, {value});", NODE),
    "node, template": ("node.set<O>({value});", NODE),
    "locked, tag": ("locked.set(O{{}}, {value});", NODE),
    "locked, template": ("locked.set<O>({value});", NODE),
    "mailbox, tag": ("box.post(O{{}}, {value});", NODE),
    "mailbox, template": ("box.post<O>({value});", NODE),
    "remote node": ("remote.write<O>({value}, now);", (*NUMBERS, *CHECKED)),
    "blocking, tag": ("objects.write(O{{}}, {value});", NODE),
    "blocking, template": ("objects.write<O>({value});", NODE),
    "PDO, pack": ("(void)canopen::PdoLayout<O>::pack({value});", CODEC),
    "PDO, set": ("canopen::PdoLayout<O>::set<0>(frame, {value});", CODEC),
    "PDO, put": ("canopen::PdoLayout<O>::put<0>(frame, {value});", CODEC),
}
# What compiles: a value of the type, of a narrower one, and a constant.
RIGHT = (Kind("type", PLAIN, "std::uint16_t value = 5;", "value"), Kind("narrower", PLAIN, "std::uint8_t value = 5;", "value"),
         Kind("constant", PLAIN, "", "5"), Kind("limited constant", LIMITED, "", "0xFFFE"),
         Kind("real constant", REAL, "", "0.5"))


def run_cell(job: tuple[Compiler, str, str, Kind, bool, Path, tuple[Path, ...], tuple[str, ...]]) -> str:
    """Returns the problem of a cell; empty if it has none."""
    compiler, way, statement, kind, is_right, folder, include, flags = job
    name = "".join(letter if letter.isalnum() else "_" for letter in f"{compiler.name} {way} {kind.name} {is_right}")
    source = folder / f"{name}.cpp"
    text = statement.format(value=kind.value)
    if is_right and "(void)" not in text:
        text = f"(void){text}"
    source.write_text(SOURCE.format(object=kind.object, declaration=kind.declaration, statement=text))
    run = compile_only(compiler, source, include, flags)
    cell = f"{compiler.name}: {way}, {kind.name}"
    if is_right:
        return f"{cell}: does not compile:\n{run.stderr[:1500]}" if run.returncode != 0 else ""
    if run.returncode == 0:
        return f"{cell}: compiles"
    lines = run.stderr.splitlines()
    if len(lines) > MOST_LINES:
        return f"{cell}: {len(lines)} lines:\n{run.stderr[:1500]}"
    is_named = kind.object.split("::")[-1] in run.stderr or "O{}" in run.stderr or "<O>" in run.stderr
    return "" if is_named else f"{cell}: does not name the object:\n{run.stderr[:1500]}"


def main() -> int:
    source_dir, generated = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    only = sys.argv[3:]
    compilers = those_installed((GCC, CLANG))
    include = (*(path for path in sorted(generated.iterdir()) if path.is_dir()), generated,
               source_dir / "runtime/include", source_dir / "tests")
    with tempfile.TemporaryDirectory() as scratch:
        jobs = []
        for compiler in compilers:
            folder = Path(scratch) / compiler.name
            folder.mkdir()
            flags = (*UNUSED_IS_FINE, *precompiled(compiler, COMMON_HEADERS, include, folder, UNUSED_IS_FINE))
            for way, (statement, kinds) in WAYS.items():
                if only and way != only[0]:
                    continue
                for kind, is_right in [*((kind, False) for kind in kinds), *((kind, True) for kind in RIGHT)]:
                    if len(only) < 2 or kind.name == only[1]:
                        jobs.append((compiler, way, statement, kind, is_right, folder, include, flags))
        problems = [problem for problem in in_parallel(run_cell, jobs) if problem]
    for problem in problems:
        print(problem)
    print(f"{len(jobs) - len(problems)} of {len(jobs)} cells, {len(compilers)} compilers")
    if not compilers:
        return SKIPPED
    return 1 if problems or not jobs else 0


if __name__ == "__main__":
    sys.exit(main())
