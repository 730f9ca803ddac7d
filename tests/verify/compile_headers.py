#!/usr/bin/env python3
"""Each header compiles alone and twice without a warning.

    compile_headers.py SOURCE_DIR EDSC [--every N]

--every N: of the headers of the runtime, g++ compiles only every Nth alone.
Tests the headers of the runtime and those that edsc generates for the reference devices and the fixtures. Whether a header
includes all that it needs is tested with g++, where it is alone or the main file. The other compilers read all headers of the
runtime, and all of a device, in one file. All headers also compile after `using namespace std;`: g++ reads those
of the runtime and of all devices in one file, the other compilers those of each device. g++ also reads all headers in a project whose macros have one capital letter.
"""

from __future__ import annotations

import argparse
import json
import re
import string
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import (ARM_GCC, CLANG, GCC, Compiler, compile_only, in_parallel, precompiled,  # noqa: E402
                               those_installed)
from support.made_fixtures import names_eds  # noqa: E402

# These are for programs of a PC: they throw the errors of its operating system, or print numbers of 64 bits, for which newlib
# has no format.
HOSTED_ONLY = ("host/descriptor.hpp", "host/event_descriptor.hpp", "host/file_storage.hpp", "host/host_bus.hpp",
               "host/host_loop.hpp", "/network_simulation/network_simulation.hpp", "/simulated_device.hpp",
               "host/slcan.hpp", "host/socketcan.hpp", "host/socketcan_frame.hpp", "host/socketcand.hpp",
               "host/stream_port.hpp")

# The names of many headers of the standard library, without `std::`.
USING_STD = "".join(f"#include <{header}>\n" for header in (
    "algorithm", "array", "bit", "chrono", "concepts", "functional", "iterator", "limits", "memory", "numeric", "optional",
    "ranges", "span", "string", "string_view", "tuple", "type_traits", "utility", "variant", "vector")) + "using namespace std;\n"
# What a header uses of others, and the includes.
QUALIFIED = re.compile(r"#include <[^>]+>|\b(?:std|canopen)::[\w:]+")
ONE_LETTER_MACROS = tuple(f"-D{letter}=1" for letter in string.ascii_uppercase)
NAMED_BY_EDS = "names"  # a device with parameters that have one letter as their name
NAMED_LIKE_STD = "ranges"  # a device whose namespace has the name of one in `std`


@dataclass(frozen=True)
class Job:
    compiler: Compiler
    what: str
    source: Path
    include: tuple[Path, ...]
    extra: tuple[str, ...] = ()

    def run(self) -> str:
        """Returns the messages of the compiler; empty if there are none."""
        result = compile_only(self.compiler, self.source, self.include, self.extra)
        if result.returncode == 0 and not result.stderr:
            return ""
        return f"{self.compiler.name}, {self.what}:\n{result.stderr[:2000]}"


def data_sheets(source_dir: Path, scratch: Path) -> list[Path]:
    fixtures = [path for path in (source_dir / "tests/fixtures").glob("*.eds") if not path.name.startswith("wrong_")]
    return sorted((source_dir / "eds").glob("*.eds")) + sorted([*fixtures, names_eds(scratch)], key=lambda path: path.name)


def options_with_numbers(sheet: Path, scratch: Path) -> Path:
    """The options of a device without typed values."""
    options = json.loads(sheet.with_suffix(".options.json").read_text(encoding="utf-8"))
    path = scratch / f"numbers_{sheet.stem}.options.json"
    path.write_text(json.dumps({**options, "typed_values": False}), encoding="utf-8")
    return path


def generate(edsc: Path, sheets: list[Path], output: Path, scratch: Path) -> list[Path]:
    """Returns the folder of each device; the reference devices have one more, without typed values."""
    def run(sheet: Path, *extra: str | Path) -> None:
        subprocess.run([edsc, "generate", sheet, "-o", output, "--color", "never", *extra], check=True, capture_output=True)

    for sheet in sheets:
        run(sheet)
        if sheet.parent.name == "eds":
            name = sheet.stem.replace("-", "_")
            run(sheet, "--name", f"numbers_{name}", "--options", options_with_numbers(sheet, scratch))
            if not (output / name / "meaning.hpp").is_file():
                raise FileNotFoundError(f"{name} does not have meaning.hpp")
    run(sheets[-1], "--name", NAMED_LIKE_STD)
    return sorted(path for path in output.iterdir() if path.is_dir())


def headers_below(root: Path) -> list[str]:
    return [str(path.relative_to(root)) for path in sorted(root.glob("**/*.hpp"))]


def source_of(headers: list[str], path: Path, first: str = "") -> Path:
    """A source that includes each of the headers twice, after the text `first`."""
    path.write_text(first + "".join(f"#include <{header}>\n" for header in headers) * 2)
    return path


def jobs_of_the_runtime(runtime: Path, compilers: list[Compiler], scratch: Path, every: int) -> list[Job]:
    """Every Nth header alone with g++; the other compilers read all headers in one file, where none is missing any more."""
    headers = headers_below(runtime)
    hosted = [header for header in headers if header.endswith(HOSTED_ONLY)]
    of_devices = [header for header in headers if header not in hosted]
    jobs = []
    for compiler in compilers:
        if compiler == GCC:
            files = [[header] for header in headers[::every]]
        elif compiler == ARM_GCC:
            files = [of_devices]
        else:
            files = [of_devices, hosted]
        for included in files:
            source = source_of(included, scratch / f"{compiler.name}-{included[0].replace('/', '-')}.cpp")
            extra = ("-fexceptions",) if set(included) & set(hosted) else ()
            what = included[0] if len(included) == 1 else f"{len(included)} headers of the runtime"
            jobs.append(Job(compiler, f"{what}, included twice", source, (runtime,), extra))
    return jobs


def different_headers(devices: list[Path]) -> list[Path]:
    """The headers that edsc generates, without those that differ from a longer one only in their data: each has other
    includes, or other words."""
    longest: dict[tuple[str, frozenset[str]], Path] = {}
    for header in sorted((header for device in devices for header in device.glob("*.hpp")), key=lambda path: path.stat().st_size):
        longest[header.name, frozenset(QUALIFIED.findall(header.read_text(encoding="utf-8")))] = header
    return sorted(longest.values())


def jobs_of_main_files(devices: list[Path], runtime: Path) -> list[Job]:
    """A main file must not have #pragma once. GNU extensions must not change a dictionary."""
    return [Job(GCC, f"{header.relative_to(header.parents[1])} as the main file", header, (header.parents[1], runtime),
                ("-x", "c++", *(["-std=gnu++20"] if header.name == "dictionary.hpp" else [])))
            for header in different_headers(devices)]


def jobs_of_all_headers(devices: list[Path], runtime: Path, scratch: Path) -> list[Job]:
    """All headers in one file, after what a project may have."""
    generated = {device.name: [f"{device.name}/{path.name}" for path in sorted(device.glob("*.hpp"))] for device in devices}
    everything = headers_below(runtime) + sum(generated.values(), [])
    of_edsc = [header for header in everything if header not in generated[NAMED_BY_EDS]]
    include = (devices[0].parent, runtime)
    return [Job(GCC, "all headers after using namespace std", source_of(everything, scratch / "using_std.cpp", USING_STD),
                include, ("-fexceptions",)),
            Job(GCC, "all headers with macros of one letter", source_of(of_edsc, scratch / "one_letter.cpp"),
                include, ("-fexceptions", *ONE_LETTER_MACROS))]


def jobs_of_devices(devices: list[Path], compiler: Compiler, runtime: Path, scratch: Path) -> list[Job]:
    folder = scratch / compiler.name
    folder.mkdir()
    hosted = [header for header in headers_below(runtime) if header.endswith(HOSTED_ONLY)]
    first = [header for header in headers_below(runtime) if header not in hosted]
    flags = precompiled(compiler, "".join(f"#include <{header}>\n" for header in first), (runtime,), folder)
    jobs = []
    for device in devices:
        headers = [f"{device.name}/{path.name}" for path in sorted(device.glob("*.hpp"))]
        jobs.append(Job(compiler, f"all headers of {device.name}, included twice",
                        source_of(headers, folder / f"{device.name}.cpp", USING_STD), (device.parent, runtime), flags))
    return jobs


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--every", type=int, default=1)
    arguments = parser.parse_args()
    source_dir, edsc = arguments.source_dir.resolve(), arguments.edsc.resolve()
    runtime = source_dir / "runtime/include"
    compilers = those_installed((GCC, CLANG, ARM_GCC))
    with tempfile.TemporaryDirectory() as temporary:
        scratch = Path(temporary)
        devices = generate(edsc, data_sheets(source_dir, scratch), scratch / "generated", scratch)
        jobs = jobs_of_the_runtime(runtime, compilers, scratch, arguments.every)
        for compiler in compilers:
            if compiler == GCC:
                jobs += jobs_of_main_files(devices, runtime)
                jobs += jobs_of_all_headers(devices, runtime, scratch)
            else:
                jobs += jobs_of_devices(devices, compiler, runtime, scratch)
        problems = [problem for problem in in_parallel(Job.run, jobs) if problem]
    for problem in problems:
        print(problem)
    print(f"{len(jobs) - len(problems)} of {len(jobs)} compilations without a message; {len(devices)} devices")
    return 1 if problems or not devices or not compilers else 0


if __name__ == "__main__":
    sys.exit(main())
