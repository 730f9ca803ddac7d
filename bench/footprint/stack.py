#!/usr/bin/env python3
"""The worst-case stack of a node by its call graph, and its recursions.

    stack.py EDSC RUNTIME [--sheet EDS] [--static-mapping]

Compiles the node of bench/footprint/node.cpp for a Cortex-M0+ (`-Os`), as measure.py does, and prints for `start`, `on_frame`
and `on_time` together the bytes of the deepest chain of calls, with that chain, and each cycle of the call graph. GCC writes the
graph (-fcallgraph-info=su). Functions of the C library (memcpy, memset) are leaves with their measured size unknown; they are
listed. A cycle is counted once: its bound is in docs/safety.md.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
from measure import BENCH, COMPILER  # noqa: E402

NODE = re.compile(r'node: \{ title: "(?P<name>[^"]+)" label: "(?P<label>[^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "(?P<caller>[^"]+)" targetname: "(?P<callee>[^"]+)"')
BYTES = re.compile(r"(\d+) bytes \((static|dynamic|dynamic,bounded)\)")


class CallGraph:
    def __init__(self, text: str):
        self.labels = {match["name"]: match["label"] for match in NODE.finditer(text)}
        self.calls: dict[str, set[str]] = {name: set() for name in self.labels}
        for match in EDGE.finditer(text):
            self.calls.setdefault(match["caller"], set()).add(match["callee"])

    def bytes_of(self, function: str) -> int:
        size = BYTES.search(self.labels.get(function, ""))
        return int(size[1]) if size else 0

    def name_of(self, function: str) -> str:
        return self.labels.get(function, function).split("\\n")[0]

    def deepest(self, function: str, above: tuple[str, ...] = ()) -> tuple[int, tuple[str, ...]]:
        """The deepest chain from a function, in which no function occurs twice."""
        below: tuple[int, tuple[str, ...]] = (0, ())
        for callee in self.calls.get(function, ()):
            if callee not in (*above, function):
                below = max(below, self.deepest(callee, (*above, function)))
        return below[0] + self.bytes_of(function), (function, *below[1])

    def cycles(self) -> set[frozenset[str]]:
        found: set[frozenset[str]] = set()

        def walk(function: str, path: list[str]) -> None:
            for callee in self.calls.get(function, ()):
                if callee in path:
                    found.add(frozenset(path[path.index(callee):]))
                else:
                    walk(callee, [*path, callee])

        for function in list(self.calls):
            walk(function, [function])
        return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("edsc", type=Path)
    parser.add_argument("runtime", type=Path)
    parser.add_argument("--sheet", type=Path, default=BENCH / "ref.eds")
    parser.add_argument("--static-mapping", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        options = ["--static-mapping"] if arguments.static_mapping else []
        subprocess.run([arguments.edsc, "generate", arguments.sheet, "--name", "device", "-o", folder, *options], check=True,
                       stderr=subprocess.DEVNULL)
        subprocess.run([*COMPILER, "-mcpu=cortex-m0plus", "-Os", "-fcallgraph-info=su", f"-I{arguments.runtime.resolve()}",
                        f"-I{folder}", "-c", BENCH / "footprint/node.cpp", "-o", folder / "node.o"], check=True)
        graph = CallGraph((folder / "node.ci").read_text())
    entry = next(name for name in graph.labels if "program" in graph.name_of(name))
    depth, chain = graph.deepest(entry)
    print(f"{depth} bytes of stack at most, in {len(chain)} functions:")
    for function in chain:
        print(f"  {graph.bytes_of(function):4}  {graph.name_of(function)}")
    library = sorted({graph.name_of(name) for name in graph.labels if not BYTES.search(graph.labels[name])})
    print("of the C library, not counted: " + (", ".join(library) or "nothing"))
    cycles = graph.cycles()
    print(f"{len(cycles)} cycles:")
    for cycle in sorted(cycles, key=len):
        print("  " + " -> ".join(sorted(graph.name_of(function) for function in cycle)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
