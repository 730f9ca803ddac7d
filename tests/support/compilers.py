"""The compilers and flags with which the runtime and generated headers must compile without a warning."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

SKIPPED = 77  # the exit code that CTest reports as skipped

WARNINGS = ("-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wpedantic", "-Werror")
FLAGS = ("-std=c++20", "-fsyntax-only", *WARNINGS, "-fno-exceptions", "-fno-rtti")


@dataclass(frozen=True)
class Compiler:
    command: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.command[0]

    @property
    def is_clang(self) -> bool:
        return "clang" in self.name

    @property
    def installed(self) -> bool:
        return shutil.which(self.name) is not None


GCC = Compiler(("g++",))
CLANG = Compiler(("clang++",))
ARM_GCC = Compiler(("arm-none-eabi-g++", "-mcpu=cortex-m0plus"))


def those_installed(compilers: Iterable[Compiler]) -> list[Compiler]:
    """Returns the installed compilers; prints the missing ones."""
    found = []
    for compiler in compilers:
        if compiler.installed:
            found.append(compiler)
        else:
            print(f"SKIPPED: {compiler.name} is not installed")
    return found


def compile_only(compiler: Compiler, source: Path, include: Sequence[Path],
                 extra: Sequence[str] = ()) -> subprocess.CompletedProcess[str]:
    """Checks a source or header without writing output."""
    folders = [f"-I{folder}" for folder in include]
    return subprocess.run([*compiler.command, *FLAGS, *extra, *folders, str(source)], capture_output=True, text=True,
                          errors="replace", timeout=600)


def precompiled(compiler: Compiler, text: str, include: Sequence[Path], folder: Path,
                extra: Sequence[str] = ()) -> tuple[str, ...]:
    """Compiles the headers that `text` includes once; returns the flags with which a source begins with them."""
    header = folder / "precompiled.hpp"
    header.write_text(text)
    output = header.with_suffix(".pch" if compiler.is_clang else ".hpp.gch")
    flags = [flag for flag in FLAGS if flag != "-fsyntax-only"]
    subprocess.run([*compiler.command, *flags, *extra, *(f"-I{path}" for path in include), "-x", "c++-header",
                    str(header), "-o", str(output)], check=True, timeout=600)
    return ("-include-pch", str(output)) if compiler.is_clang else ("-Winvalid-pch", "-include", str(header))


def in_parallel(job, arguments: Iterable) -> list:
    """Returns the results of `job(argument)` in order; runs EDSC_TEST_JOBS jobs at a time, by default one per core."""
    workers = int(os.environ.get("EDSC_TEST_JOBS", os.cpu_count() or 1))
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(job, arguments))
