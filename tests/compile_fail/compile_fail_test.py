#!/usr/bin/env python3
"""Each mistake here does not compile, and the message of the compiler names the wrong object.

    compile_fail_test.py SOURCE_DIR GENERATED_DIR [CASE] [--gcc-every N] [--clang-every N]

GENERATED_DIR has a folder for each device. --gcc-every N, --clang-every N: this compiler compiles only every Nth case.

A case is a .cpp file. It compiles with GOOD defined, and does not compile without. Then the first 12 messages of the
compiler must match each of its lines `// expect: regex`. `A .*B` requires A and B in any order, as the order differs between GCC and Clang; `A|B`
requires one of them. The messages have at most 12 lines; with the compilers of Debian 13, 18.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import (CLANG, GCC, SKIPPED, Compiler, compile_only, in_parallel, precompiled,  # noqa: E402
                               those_installed)
from support.messages import MOST_LINES, messages_of_cases, without_lists  # noqa: E402

EXPECTATION = re.compile(r"^// expect: (.+)$", re.MULTILINE)
CUT_OFF = re.compile(r"^// \.\*", re.MULTILINE)  # of a line that was wrapped
INCLUDE = re.compile(r"^#include .+$", re.MULTILINE)
MESSAGE = re.compile(r"^\S+:\d+:(\d+:)? |^\S+: In ")
READ_MESSAGES = 12
CASES_IN_A_UNIT = 8
# Why the messages of a case may have more lines than MOST_LINES, without the lists of including files.
LONGER = {
    "application_deduced_result": "a deduced result needs the body of the function, before the node is complete",
    "application_every_0_ms": "the compilers continue after the wrong type of a parameter, which they then do not know",
    "application_every_hour": "like application_every_0_ms",
    "checked_pdo_over_64_bits": "Clang: the layout, its base and its check are one template each",
    "checked_pdo_unmappable_object": "like checked_pdo_over_64_bits",
    "checked_pdo_variable_length": "like checked_pdo_over_64_bits",
    "plant_signal_that_is_sent": "g++ describes how the concept is not satisfied",
    "fixed_string_too_long": "Clang describes how it came from a concept to the class",
}
# Cases that Clang 14 compiles: can/node_id.hpp, od/value.hpp.
GCC_ALONE = ("node_id_0", "node_id_128", "set_octets_too_long")
UNUSED_IS_FINE = ("-Wno-unused",)
# What nearly all cases include, compiled once for each compiler: it takes most of the time of a case.
COMMON_HEADERS = """#include <canopen/node.hpp>
#include <canopen/pdo/pdo_compatible.hpp>
#include <canopen/sdo/remote_node.hpp>
#include <every_type/device.hpp>
"""


def beginning(output: str) -> str:
    """The first messages, with their excerpts of sources. Lists of including files are not counted."""
    lines: list[str] = []
    for line in output.splitlines():
        if MESSAGE.match(line) and sum(1 for shown in lines if MESSAGE.match(shown)) == READ_MESSAGES:
            break
        lines.append(line)
    return "\n".join(lines)


def says(output: str, expectation: str) -> bool:
    return any(all(re.search(part, output) for part in alternative.split(" .*"))
               for alternative in expectation.split("|"))


@dataclass(frozen=True)
class Unit:
    """Cases that are compiled as one file, which takes a third of the time of all. A case that does not pass in it is compiled
    alone: of several cases with one error of a template, the compiler reports the first."""
    compiler: Compiler
    cases: tuple[Path, ...]
    folder: Path
    include: tuple[Path, ...]
    flags: tuple[str, ...]

    def compile(self, case: Path, *flags: str) -> subprocess.CompletedProcess[str]:
        return compile_only(self.compiler, case, self.include, (*flags, *self.flags))


def units_of(compiler: Compiler, cases: list[Path], folder: Path, include: tuple[Path, ...], flags: tuple[str, ...]) -> list[Unit]:
    """Neighbours, which often have the same error, are in different units."""
    count = -(-len(cases) // CASES_IN_A_UNIT)
    return [Unit(compiler, tuple(cases[first::count]), folder / f"unit_{first}", include, flags) for first in range(count)]


def messages_of_unit(unit: Unit, first: str) -> dict[str, list[str]]:
    """The messages of each case after the line `first`, by the name of the case. Each case is in a namespace of its own."""
    headers = dict.fromkeys(line for case in unit.cases for line in INCLUDE.findall(case.read_text()))
    texts = [(case.stem, f"namespace case_{case.stem} {{\n{INCLUDE.sub('', case.read_text())}\n}}\n") for case in unit.cases]
    texts[0] = (texts[0][0], "\n".join((first, *headers, texts[0][1])))
    folder = unit.folder / ("good" if first else "bad")
    return messages_of_cases(unit.compiler, texts, folder, unit.include, unit.flags)


def run_unit(unit: Unit) -> list[str]:
    """Returns the problems of its cases."""
    unit.folder.mkdir()
    good, bad = messages_of_unit(unit, "#define GOOD"), messages_of_unit(unit, "")
    return [problem for case in unit.cases
            if (problem := problem_of_case(case) or problem_of_good(unit, case, any(good.values()))
                or problem_of_bad(unit, case, bad[case.stem] if not bad[""] else []))]


def problem_of_case(case: Path) -> str:
    if not EXPECTATION.search(case.read_text()):
        return f"{case.name}: its first line is not `// expect: regex`"
    if CUT_OFF.search(case.read_text()):
        return f"{case.name}: an expectation continues on the next line, which is not checked"
    return ""


def problem_of_good(unit: Unit, case: Path, has_messages: bool) -> str:
    """`has_messages`: the compiler reports something for the unit of the case."""
    if not has_messages:
        return ""
    good = unit.compile(case, "-DGOOD")
    return f"{unit.compiler.name}, {case.name}: does not compile with GOOD:\n{good.stderr[:2000]}" if good.returncode else ""


def problem_of_bad(unit: Unit, case: Path, messages: list[str]) -> str:
    """`messages`: of the case in its unit."""
    if messages and not problem_of_messages(case, "\n".join(messages)):
        return ""
    bad = unit.compile(case)
    problem = problem_of_messages(case, bad.stderr) if bad.returncode else "compiles without GOOD"
    return f"{unit.compiler.name}, {case.name}: {problem}:\n{bad.stderr[:3000]}" if problem else ""


def problem_of_messages(case: Path, output: str) -> str:
    missing = [one for one in EXPECTATION.findall(case.read_text()) if not says(beginning(output), one)]
    lines = without_lists(output)
    if case.stem not in LONGER and len(lines) > MOST_LINES:
        return f"{len(lines)} lines"
    return f"its message does not match `{missing[0]}`" if missing else ""


def main() -> int:
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("generated", type=Path)
    parser.add_argument("case", nargs="?", default="*")
    parser.add_argument("--gcc-every", type=int, default=1)
    parser.add_argument("--clang-every", type=int, default=1)
    arguments = parser.parse_args()
    source_dir, generated = arguments.source_dir.resolve(), arguments.generated.resolve()
    cases = sorted((source_dir / "tests/compile_fail").glob(f"{arguments.case}.cpp"))
    compilers = those_installed((GCC, CLANG))
    include = (*(path for path in sorted(generated.iterdir()) if path.is_dir()), source_dir / "runtime/include",
               source_dir / "tests")
    with tempfile.TemporaryDirectory() as scratch:
        units = []
        for compiler in compilers:
            folder = Path(scratch) / compiler.name
            folder.mkdir()
            headers = precompiled(compiler, COMMON_HEADERS, include, folder, UNUSED_IS_FINE)
            chosen = cases[::arguments.gcc_every]
            if compiler.is_clang:
                chosen = [case for case in cases if case.stem not in GCC_ALONE][::arguments.clang_every]
            units += units_of(compiler, chosen, folder, include, (*UNUSED_IS_FINE, *headers))
        problems = [problem for found in in_parallel(run_unit, units) for problem in found]
    for problem in problems:
        print(problem)
    count = sum(len(unit.cases) for unit in units)
    print(f"{count - len(problems)} of {count}: {len(cases)} cases, {len(compilers)} compilers")
    if not compilers:
        return SKIPPED
    return 1 if problems or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
