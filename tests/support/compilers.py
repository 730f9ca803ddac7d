"""The compilers that the runtime and generated headers must please, and the flags that they must bear."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

SKIPPED = 77  # what CTest is told to take for "skipped"

FLAGS = (
    "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wpedantic", "-Werror",
    "-fno-exceptions", "-fno-rtti",
)


@dataclass(frozen=True)
class Compiler:
    command: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.command[0]

    @property
    def installed(self) -> bool:
        return shutil.which(self.name) is not None


GCC = Compiler(("g++",))
CLANG = Compiler(("clang++",))
ARM_GCC = Compiler(("arm-none-eabi-g++", "-mcpu=cortex-m0plus"))


def those_installed(compilers: Iterable[Compiler]) -> list[Compiler]:
    """Says aloud which are not there."""
    found = []
    for compiler in compilers:
        if compiler.installed:
            found.append(compiler)
        else:
            print(f"SKIPPED: {compiler.name} is not installed")
    return found


def compile_only(compiler: Compiler, source: Path, include: Sequence[Path],
                 extra: Sequence[str] = ()) -> subprocess.CompletedProcess[str]:
    """Looks at a source or header without writing anything."""
    folders = [f"-I{folder}" for folder in include]
    return subprocess.run([*compiler.command, *FLAGS, *extra, *folders, str(source)], capture_output=True, text=True,
                          errors="replace", timeout=600)


def in_parallel(job, arguments: Iterable) -> list:
    """Results of `job(argument)`, in order; as many at a time as CTest says or the machine has cores."""
    workers = int(os.environ.get("EDSC_TEST_JOBS", os.cpu_count() or 1))
    with ThreadPoolExecutor(workers) as pool:
        return list(pool.map(job, arguments))
