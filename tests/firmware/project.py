"""A project of a user of edsc_add_firmware, in its own folder."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

SOURCE_DIR = Path(__file__).resolve().parents[2]
TOOLCHAIN = SOURCE_DIR / "cmake/toolchains/arm-none-eabi.cmake"
LONGEST = 1200  # s, timeout for a step of the build
LISTS = """cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
add_subdirectory("{source}" edsc)
{lines}
"""


@dataclass
class Project:
    folder: Path
    edsc: Path

    def configure(self, lines: str, *options: str, build_type: str = "Release") -> str:
        """Returns the output of CMake."""
        (self.folder / "CMakeLists.txt").write_text(LISTS.format(source=SOURCE_DIR, lines=lines))
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        result = self.run("cmake", "-S", self.folder, "-B", self.build_dir, "-G", "Ninja", f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}",
                          f"-DCMAKE_BUILD_TYPE={build_type}", f"-DEDSC_EXECUTABLE={self.edsc}", *launcher, *options)
        if result.returncode != 0:
            raise AssertionError(result.stdout)
        return result.stdout

    def build(self, *targets: str) -> subprocess.CompletedProcess[str]:
        wanted = ["--target", *targets] if targets else []
        return self.run("cmake", "--build", self.build_dir, "-j2", *wanted)

    @property
    def build_dir(self) -> Path:
        return self.folder / "build"

    @staticmethod
    def run(*command: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=LONGEST)
