"""A project that uses edsc: a copy of examples/project in another folder.

The arguments of the scripts that use it are SOURCE_DIR and BUILD_DIR. BUILD_DIR is a build of edsc, from which it is installed.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
BUILD_DIR = Path(sys.argv[2]).resolve()
FROM_PACKAGE = "find_package(edsc REQUIRED)"
TOOLCHAIN = "toolchains/arm-none-eabi.cmake"
EM_ARM = 40  # e_machine of the ELF header
WITHOUT_ARM = "" if shutil.which("arm-none-eabi-g++") else "SKIPPED: arm-none-eabi-g++ is not installed"

ENVIRONMENT = {name: value for name, value in os.environ.items() if name not in ("CMAKE_PREFIX_PATH", "DESTDIR")}
ENVIRONMENT["CMAKE_BUILD_TYPE"] = "Release"


def use_compiler_cache(folder: Path) -> None:
    """Objects compiled below this folder do not depend on its location.

    Its path must not contain a blank: ccache 4.7 does not make such a path relative in the dependency files that it keeps,
    so that a later hit names files of a folder which no longer exists, and the object is compiled again and again.
    """
    assert " " not in str(folder), folder
    if shutil.which("ccache"):
        ENVIRONMENT.update(CMAKE_CXX_COMPILER_LAUNCHER="ccache", CCACHE_BASEDIR=str(folder))


def run(*command: object, folder: Path | None = None, variables: dict[str, str] | None = None) -> str:
    """The output of a command that must succeed."""
    result = subprocess.run([str(word) for word in command], cwd=folder, env=ENVIRONMENT | (variables or {}),
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            errors="replace", timeout=1700)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {result.returncode}\n{result.stdout[-4000:]}")
    return result.stdout


def copy_sources(to: Path) -> None:
    """Copies the working tree without build folders and git."""
    shutil.copytree(SOURCE_DIR, to, symlinks=True,
                    ignore=shutil.ignore_patterns("build", "out", ".git", ".cache", "__pycache__"))


class Project:
    """A copy of examples/project in `source`; `edsc` replaces its find_package, `more` is appended.

    In a folder with a blank in its path the compiler cache is disabled (see use_compiler_cache).
    """

    def __init__(self, source: Path, edsc: str = FROM_PACKAGE, more: str = "", build_dir: Path | None = None) -> None:
        self.source = source
        self.build_dir = build_dir or source / "build"
        self.variables = {"CCACHE_DISABLE": "1"} if " " in f"{self.source}{self.build_dir}" else {}
        shutil.copytree(SOURCE_DIR / "examples/project", source, dirs_exist_ok=True)
        lists = self.lists.read_text()
        assert FROM_PACKAGE in lists
        self.lists.write_text(lists.replace(FROM_PACKAGE, edsc) + more)

    @property
    def lists(self) -> Path:
        return self.source / "CMakeLists.txt"

    @property
    def sheet(self) -> Path:
        return self.source / "valve.eds"

    def configure(self, *settings: object) -> str:
        return run("cmake", "-S", self.source, "-B", self.build_dir, "-G", "Ninja", *settings, variables=self.variables)

    def build(self, *targets: str) -> str:
        return run("cmake", "--build", self.build_dir, *(["--target", *targets] if targets else []),
                   variables=self.variables)


class PackageTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc package ")).resolve()  # with a blank on purpose
        self.addCleanup(shutil.rmtree, self.folder)

    def install(self) -> Path:
        """Installs edsc and returns the prefix."""
        prefix = self.folder / "prefix"
        run("cmake", "--install", BUILD_DIR, "--prefix", prefix)
        return prefix
