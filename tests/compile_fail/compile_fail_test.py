#!/usr/bin/env python3
"""Each mistake here does not compile, and the message of the compiler names the wrong object.

    compile_fail_test.py SOURCE_DIR GENERATED_DIR [CASE]      GENERATED_DIR has a folder for each device

A case is a .cpp file. It compiles with GOOD defined, and does not compile without. Then the first 12 messages of the
compiler must match each of its lines `// expect: regex`. `A .*B` requires A and B in any order, as the order differs between GCC and Clang; `A|B`
requires one of them. The messages have at most 12 lines.
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import (CLANG, GCC, SKIPPED, Compiler, compile_only, in_parallel, precompiled,  # noqa: E402
                               those_installed)
from support.messages import without_lists  # noqa: E402

EXPECTATION = re.compile(r"^// expect: (.+)$", re.MULTILINE)
CUT_OFF = re.compile(r"^// \.\*", re.MULTILINE)  # of a line that was wrapped
MESSAGE = re.compile(r"^\S+:\d+:(\d+:)? |^\S+: In ")
READ_MESSAGES = 12
# The lines that all messages of a case may have, without the lists of including files. LONGER: why a case may have more.
MOST_LINES = 12
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
# Cases that Clang 14 compiles: can/node_id.hpp.
GCC_ALONE = ("node_id_0", "node_id_128")
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


def run_case(job: tuple[Compiler, Path, tuple[Path, ...], tuple[str, ...]]) -> str:
    """Returns the problem of the case; empty if it has none."""
    compiler, case, include, flags = job
    expectations = EXPECTATION.findall(case.read_text())
    if not expectations:
        return f"{case.name}: its first line is not `// expect: regex`"
    if CUT_OFF.search(case.read_text()):
        return f"{case.name}: an expectation continues on the next line, which is not checked"
    good = compile_only(compiler, case, include, ("-DGOOD", *flags))
    if good.returncode != 0:
        return f"{compiler.name}, {case.name}: does not compile with GOOD:\n{good.stderr[:2000]}"
    bad = compile_only(compiler, case, include, flags)
    if bad.returncode == 0:
        return f"{compiler.name}, {case.name}: compiles without GOOD"
    missing = [expectation for expectation in expectations if not says(beginning(bad.stderr), expectation)]
    lines = without_lists(bad.stderr)
    if case.stem not in LONGER and len(lines) > MOST_LINES:
        return f"{compiler.name}, {case.name}: {len(lines)} lines:\n{bad.stderr[:3000]}"
    if missing:
        return f"{compiler.name}, {case.name}: its message does not match `{missing[0]}`:\n{bad.stderr[:3000]}"
    return ""


def main() -> int:
    source_dir, generated = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    name = sys.argv[3] if len(sys.argv) > 3 else "*"
    cases = sorted((source_dir / "tests/compile_fail").glob(f"{name}.cpp"))
    compilers = those_installed((GCC, CLANG))
    include = (*(path for path in sorted(generated.iterdir()) if path.is_dir()), source_dir / "runtime/include",
               source_dir / "tests")
    with tempfile.TemporaryDirectory() as scratch:
        jobs = []
        for compiler in compilers:
            folder = Path(scratch) / compiler.name
            folder.mkdir()
            headers = precompiled(compiler, COMMON_HEADERS, include, folder, UNUSED_IS_FINE)
            jobs += [(compiler, case, include, (*UNUSED_IS_FINE, *headers)) for case in cases
                     if not (compiler.is_clang and case.stem in GCC_ALONE)]
        problems = [problem for problem in in_parallel(run_case, jobs) if problem]
    for problem in problems:
        print(problem)
    print(f"{len(jobs) - len(problems)} of {len(jobs)}: {len(cases)} cases, {len(compilers)} compilers")
    if not compilers:
        return SKIPPED
    return 1 if problems or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
