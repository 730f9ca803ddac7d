#!/usr/bin/env python3
"""Each header compiles alone and twice without a warning, a generated one also as the main file.

    compile_headers.py SOURCE_DIR EDSC

Tests the headers of the runtime and those that edsc generates for the reference devices and the fixtures.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import ARM_GCC, CLANG, GCC, Compiler, compile_only, in_parallel, those_installed  # noqa: E402

PARTS_OF_A_DEVICE = ("/dictionary.hpp", "/pdo.hpp")  # device.hpp includes them, so that all compilers compile them there
# These need an operating system, whose errors they throw.
HOSTED_ONLY = ("port/descriptor.hpp", "port/event_descriptor.hpp", "port/file_storage.hpp", "port/host_bus.hpp",
               "port/host_loop.hpp", "port/simulated_device.hpp", "port/slcan.hpp", "port/socketcan.hpp",
               "port/socketcand.hpp", "port/stream_port.hpp")


@dataclass(frozen=True)
class Header:
    root: Path  # the include directory
    path: str   # relative to it

    def __str__(self) -> str:
        return self.path


@dataclass(frozen=True)
class Job:
    compiler: Compiler
    header: Header
    source: Path
    include: tuple[Path, ...]
    extra: tuple[str, ...]
    how: str

    def run(self) -> str:
        """Returns the messages of the compiler; empty if there are none."""
        result = compile_only(self.compiler, self.source, self.include, self.extra)
        if result.returncode == 0 and not result.stderr:
            return ""
        return f"{self.compiler.name}, {self.header}, {self.how}:\n{result.stderr[:2000]}"


def data_sheets(source_dir: Path) -> list[Path]:
    fixtures = [path for path in (source_dir / "tests/fixtures").glob("*.eds") if not path.name.startswith("wrong_")]
    return sorted((source_dir / "eds").glob("*.eds")) + sorted(fixtures)


def generate(edsc: Path, sheets: list[Path], output: Path) -> list[Header]:
    for sheet in sheets:
        subprocess.run([edsc, "generate", sheet, "-o", output, "--color", "never"], check=True, capture_output=True)
    return [Header(output, str(path.relative_to(output))) for path in sorted(output.glob("*/*.hpp"))]


def runtime_headers(root: Path) -> list[Header]:
    return [Header(root, str(path.relative_to(root))) for path in sorted(root.glob("canopen/**/*.hpp"))]


def jobs_of(header: Header, compilers: list[Compiler], runtime: Path, scratch: Path) -> list[Job]:
    twice = scratch / (header.path.replace("/", "-") + ".cpp")
    twice.write_text(f"#include <{header.path}>\n#include <{header.path}>\n")
    include = (header.root, runtime)
    hosted = header.path.endswith(HOSTED_ONLY)
    jobs = []
    for compiler in compilers:
        if compiler == ARM_GCC and hosted:
            continue
        if not header.path.endswith(PARTS_OF_A_DEVICE):
            jobs.append(Job(compiler, header, twice, include, ("-fexceptions",) if hosted else (), "included twice"))
    if header.root != runtime and GCC in compilers:  # a main file must not have #pragma once
        jobs.append(Job(GCC, header, header.root / header.path, include, ("-x", "c++"), "as the main file"))
    if header.path.endswith("dictionary.hpp") and GCC in compilers:
        jobs.append(Job(GCC, header, twice, include, ("-std=gnu++20",), "with GNU extensions"))
    return jobs


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    runtime = source_dir / "runtime/include"
    compilers = those_installed((GCC, CLANG, ARM_GCC))
    with tempfile.TemporaryDirectory() as temporary:
        scratch = Path(temporary)
        headers = runtime_headers(runtime) + generate(edsc, data_sheets(source_dir), scratch / "generated")
        jobs = [job for header in headers for job in jobs_of(header, compilers, runtime, scratch)]
        problems = [problem for problem in in_parallel(Job.run, jobs) if problem]
    for problem in problems:
        print(problem)
    print(f"{len(jobs) - len(problems)} of {len(jobs)} compilations of {len(headers)} headers without a message")
    return 1 if problems or not headers or not compilers else 0


if __name__ == "__main__":
    sys.exit(main())
