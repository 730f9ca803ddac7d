#!/usr/bin/env python3
"""How many functions and files a frame passes through in a node, as a reader meets them.

    paths.py EDSC RUNTIME [PATH]

Compiles bench/footprint/paths.cpp for this machine without optimization, with -finstrument-functions, for the device of
bench/ref.eds with dynamic mapping, and runs it. Prints for an SDO download, from `on_frame` to the function of the application and the
response, an SDO upload, an RPDO, a SYNC with four TPDOs, and an event-driven TPDO from the `set` of the application on, the number of different functions that are called, and how deep the
calls are. A template is one function, and so are the generic lambdas of a line; functions of the standard library are not counted.
The files are those of the functions, without the vocabulary of `base`, `can` and `od` that all paths share. With the name of a
path, prints its calls.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

BENCH = Path(__file__).resolve().parents[1]
VOCABULARY = ("base", "can", "od")


class Call(NamedTuple):
    depth: int
    function: str
    place: str  # file:line

    @property
    def file(self) -> str:
        return self.place.partition(":")[0]


def without_arguments(function: str) -> str:
    """canopen::Node<..>::on_frame(..) -> canopen::Node::on_frame"""
    depth = 0
    kept = []
    for character in function.replace("operator()", "operator").replace("{lambda", "lambda").partition("(")[0]:
        depth += character == "<"
        if depth == 0:
            kept.append(character)
        depth -= character == ">"
    return "".join(kept).split(" ")[-1]


def build(edsc: str, runtime: Path, folder: Path) -> Path:
    program = folder / "paths"
    subprocess.run([edsc, "generate", BENCH / "ref.eds", "-o", folder, "--name", "device"], check=True, capture_output=True)
    subprocess.run(["g++", "-std=c++20", "-O0", "-g1", "-no-pie", "-finstrument-functions",
                    "-finstrument-functions-exclude-file-list=/usr/", f"-I{runtime}", f"-I{folder}",
                    BENCH / "footprint/paths.cpp", "-o", program], check=True)
    return program


def paths_of(program: Path, runtime: Path) -> Iterator[tuple[str, list[Call]]]:
    output = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    addresses = sorted(set(re.findall(r"0x[0-9a-f]+", output)))
    symbols = subprocess.run(["addr2line", "-f", "-C", "-e", program, *addresses], check=True, capture_output=True,
                             text=True).stdout.splitlines()
    calls = {address: (without_arguments(symbols[2 * i]), re.sub(r" \(.*", "", symbols[2 * i + 1]))
             for i, address in enumerate(addresses)}
    for block in output.split("path ")[1:]:
        name, *lines = block.splitlines()
        found = []
        for line in lines:
            depth, address = line.split()
            function, place = calls[address]
            found.append(Call(int(depth), function, place.removeprefix(f"{runtime / 'canopen'}/").rpartition("..")[2]))
        yield name, found


def main() -> int:
    if len(sys.argv) not in (3, 4):
        print(__doc__)
        return 2
    runtime = Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        paths = dict(paths_of(build(sys.argv[1], runtime, Path(folder)), runtime))
    if len(sys.argv) == 4:
        for call in paths[sys.argv[3]]:
            print(f"{'  ' * call.depth}{call.function}  {call.place}")
        return 0
    print(f"{'path':14}{'functions':>10}{'deepest':>9}{'files':>7}")
    for name, calls in paths.items():
        own = [call for call in calls if not call.file.startswith("/")]
        files = {call.file for call in own if call.file.partition("/")[0] not in VOCABULARY}
        print(f"{name:14}{len({call.place for call in own}):10}{max(call.depth for call in own):9}{len(files):7}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
