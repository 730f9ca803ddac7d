"""The mutated files, and the programs that test them."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Program:
    """A program that tests the files whose paths begin with one of `tests`."""

    name: str
    tests: tuple[str, ...]
    command: tuple[str, ...]  # {source} and {build} are the folders of the mutated copy
    targets: tuple[str, ...]

    def is_for(self, file: str) -> bool:
        return file.startswith(self.tests)


@dataclass(frozen=True)
class Area:
    """Files whose mutants are in one build."""

    name: str
    folders: tuple[str, ...]
    programs: tuple[Program, ...]
    cmake_options: tuple[str, ...] = ()
    excluded: tuple[str, ...] = ()
    # Otherwise constexpr variables are omitted, as parts of types and tables that the compiler evaluates.
    mutates_constexpr_variables: bool = False

    def has(self, file: str) -> bool:
        return file.startswith(self.folders) and not file.startswith(self.excluded)


@dataclass(frozen=True)
class Project:
    root: Path
    areas: tuple[Area, ...]
    include_folders: tuple[str, ...]
    equivalents: Path | None = None

    def files(self, under: tuple[str, ...]) -> list[str]:
        paths = (path for area in self.areas for folder in area.folders
                 for path in (self.root / folder).rglob("*.[ch]pp"))
        names = sorted(str(path.relative_to(self.root)) for path in paths)
        return [name for name in names if name.startswith(under) and self.area_of(name) is not None]

    def area_of(self, file: str) -> Area | None:
        return next((area for area in self.areas if area.has(file)), None)

    def compile_arguments(self, root: Path) -> list[str]:
        return ["-std=c++20", *(f"-I{root / folder}" for folder in self.include_folders)]


def gtest(name: str, *tests: str) -> Program:
    return Program(name, tests, (f"{{build}}/tests/{name}", "--gtest_fail_fast", "--gtest_brief=1"), (name,))


def script(name: str, path: str, *tests: str) -> Program:
    """A Python script that is called with the source folder and the command edsc."""
    return Program(name, tests, (sys.executable, f"{{source}}/tests/{path}", "{source}", "{build}/generator/edsc"),
                   ("edsc",))


RUNTIME = "runtime/include/canopen/"
SIMULATION = "runtime/include/canopen_sim/"
PLANT = "runtime/include/canopen_plant/"

HOST = ("generator/", "bus/", "cli/")

# Fast programs first: no program runs after the first failure.
HOST_PROGRAMS = (
    gtest("decode_tests", "bus/decode/", "generator/values/", "generator/text/", "generator/device/"),
    gtest("live_tests", "bus/configure/", "bus/monitor/", "bus/online/"),
    gtest("bus_server_tests", "bus/server/"),
    gtest("generator_tests", "generator/"),
    Program("conform_mutants", ("bus/conform/",),
            ("{build}/tests/conform_mutants", "{source}/tests/bus/conform/mutants.tsv"), ("conform_mutants",)),
    script("golden", "golden/golden_test.py", "generator/"),
    script("check", "cli/check_test.py", "generator/", "cli/"),
    script("decode", "bus/decode/decode_test.py", "bus/decode/", "generator/values/", "cli/"),
    script("completion", "cli/completion_test.py", "cli/completion/"),
    script("rules", "generator/lint/rules_test.py", "generator/lint/", "generator/eds/", "generator/xdd/",
           "generator/diagnostics/", "generator/rules/"),
    script("options", "generator/device/options_test.py", "generator/device/options/"),
    script("cli_diff", "cli/diff_test.py", "generator/compare/", "cli/"),
    script("cli_format", "cli/format_test.py", "generator/format/", "cli/"),
    script("cli", "cli/cli_test.py", *HOST),
)
RUNTIME_PROGRAMS = (
    gtest("profile_tests", f"{RUNTIME}profile/"),
    gtest("cia402_tests", f"{RUNTIME}profile/"),
    gtest("can_controller_tests", f"{RUNTIME}port/"),
    gtest("port_tests", f"{RUNTIME}host/", f"{RUNTIME}port/", f"{RUNTIME}can/send_queue.hpp",
          f"{RUNTIME}node/accepted_frames.hpp", SIMULATION),
    gtest("model_tests", RUNTIME),
    gtest("runtime_tests", RUNTIME, SIMULATION, PLANT),
    gtest("node_tests", RUNTIME),
)

# Schemata contain many comparisons that cause warnings, and in tests of the runtime a warning is an error.
NO_WARNINGS = "-DCMAKE_CXX_FLAGS=-O1 -w"


def edsc_project(root: Path, edsc: Path | None) -> Project:
    """`edsc` generates the code for tests of the runtime; None: it is built from the copy with the mutants."""
    host = Area(
        "host", HOST, HOST_PROGRAMS,
        # Each source is compiled alone, as for the test preset: those without a mutant come from the compiler's cache.
        cmake_options=("-DCMAKE_BUILD_TYPE=Release", "-DEDSC_UNITY_BUILD=OFF", "-DEDSC_BUILD_EXAMPLES=OFF"),
        mutates_constexpr_variables=True)
    given = () if edsc is None else (f"-DEDSC_EXECUTABLE={edsc.resolve()}", "-DEDSC_HOST_PRESET=given")
    runtime = Area(
        "runtime", ("runtime/include/",), RUNTIME_PROGRAMS,
        cmake_options=("-DCMAKE_BUILD_TYPE=None", NO_WARNINGS, "-DEDSC_BUILD_EXAMPLES=OFF", *given),
        # The sockets of the kernel are tested in a virtual machine.
        excluded=(f"{RUNTIME}host/socketcan.hpp", f"{RUNTIME}host/socketcan_frame.hpp"))
    return Project(root, (host, runtime), ("generator", "bus", "cli", "runtime/include"),
                   root / "tests/mutation/equivalents.tsv")
