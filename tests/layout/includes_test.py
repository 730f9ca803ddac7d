#!/usr/bin/env python3
"""The include graph is that of docs/developers/architecture.md, and no module includes a higher one.

    includes_test.py SOURCE_DIR [unittest arguments]

The page has tables of modules, each with the modules that it may include. A module is below all modules that include it.
A folder of the runtime is a module, and so is each of its umbrella headers. Its headers at old include paths are one module: each
only includes the header at the new path, and no other file includes it.
"""

from __future__ import annotations

import re
import sys
import unittest
from collections import defaultdict
from graphlib import TopologicalSorter
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
RUNTIME = "runtime/include/canopen"
OLD_PATHS = "runtime/old_paths"
TOPS = {"runtime": "runtime/include", "generator": "generator", "bus": "bus", "cli": "cli"}  # each with its include folder
UMBRELLAS = ("node.hpp", "master.hpp")
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
ANY_INCLUDE = re.compile(r'#include ["<]([^">]+)')
OLD_PATH = re.compile(r'/// The old include path of (\S+), which is removed after version \d+\.\d+\.\n#pragma once\n\n#include "\1"\n')
SYSTEM_HEADER = re.compile(r"^#include <((?:arpa|net|netinet|sys|linux)/[\w./]+|"
                           r"(?:dirent|dlfcn|fcntl|poll|pthread|pwd|signal|spawn|termios|unistd|windows)\.h)>", re.MULTILINE)
ROW = re.compile(r"^\| `((?:runtime|generator|bus|cli)(?:/[\w.]+)?)/?` \| (.*?) \|", re.MULTILINE)


def top_of(path: Path) -> str:
    return path.relative_to(SOURCE_DIR).parts[0]


def name_of(path: Path) -> str:
    """Returns the name by which other files include this one."""
    return path.relative_to(SOURCE_DIR / TOPS[top_of(path)]).as_posix()


def module_of(path: Path) -> str:
    """Returns `bus/conform` for bus/conform/cases/setup.cpp, `cli` for cli/main.cpp, `runtime/node.hpp` for node.hpp, and
    `runtime/canopen_sim` for canopen_sim/virtual_bus.hpp."""
    if top_of(path) == "runtime":
        if OLD_PATH.fullmatch(path.read_text(encoding="utf-8")):
            return OLD_PATHS
        if not path.is_relative_to(SOURCE_DIR / RUNTIME):
            return f"runtime/{Path(name_of(path)).parts[0]}"
        inside = path.relative_to(SOURCE_DIR / RUNTIME)
        return f"runtime/{inside.parts[0]}" if len(inside.parts) > 1 or inside.name in UMBRELLAS else "runtime"
    return "/".join(path.relative_to(SOURCE_DIR).parts[:-1][:2])


def sources() -> list[Path]:
    return [path for top in TOPS for path in sorted((SOURCE_DIR / top).rglob("*.[ch]pp"))]


def found_includes() -> dict[str, dict[str, str]]:
    """Returns, for each module, the modules that it includes, each with an include. All modules may include the runtime."""
    known = {name_of(path): module_of(path) for path in sources()}
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for path in sources():
        module = module_of(path)
        found[module]
        for name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            other = known.get(name)
            if other is None or other == module:
                continue
            if top_of(path) == "runtime" or not other.startswith("runtime"):
                found[module].setdefault(other, f"{path.relative_to(SOURCE_DIR)} includes {name}")
    return dict(found)


def documented_includes() -> dict[str, set[str]]:
    page = (SOURCE_DIR / "docs/developers/architecture.md").read_text(encoding="utf-8")
    return {module: set(re.findall(r"`([\w/.]+)`", cell)) for module, cell in ROW.findall(page)}


class Includes(unittest.TestCase):
    maxDiff = None

    def test_names_of_headers_are_unique(self) -> None:
        names = [name_of(path) for path in sources()]
        self.assertEqual(sorted(names), sorted(set(names)))

    def test_each_include_between_modules_is_documented(self) -> None:
        documented, found = documented_includes(), found_includes()
        self.assertEqual(sorted(documented), sorted(found), "modules of docs/developers/architecture.md and of the tree")
        undocumented = [text for module, others in found.items() for other, text in others.items()
                        if other not in documented[module]]
        self.assertEqual(undocumented, [])

    def test_each_documented_include_exists(self) -> None:
        found = found_includes()
        stale = [f"{module} -> {other}" for module, others in documented_includes().items() for other in sorted(others)
                 if other not in found.get(module, {})]
        self.assertEqual(stale, [])

    def test_nothing_includes_upward(self) -> None:
        documented = documented_includes()
        tuple(TopologicalSorter(documented).static_order())  # raises CycleError with the cycle
        rank = {top: place for place, top in enumerate(TOPS)}
        upward = [f"{module} -> {other}" for module, others in documented.items() for other in others
                  if rank[other.split("/")[0]] > rank[module.split("/")[0]]]
        self.assertEqual(upward, [])

    def test_one_module_of_the_compiler_uses_the_operating_system(self) -> None:
        found = [f"{path.relative_to(SOURCE_DIR)}: {name}" for path in sources()
                 if top_of(path) in ("generator", "cli") and module_of(path) != "generator/system"
                 for name in SYSTEM_HEADER.findall(path.read_text(encoding="utf-8"))]
        self.assertEqual(found, [], "headers of POSIX belong into generator/system")

    def test_the_runtime_includes_itself_alone(self) -> None:
        names = {f"{path.relative_to(SOURCE_DIR)}: {name}"
                 for path in (SOURCE_DIR / "runtime/include").rglob("*.hpp")
                 for name in INCLUDE.findall(path.read_text(encoding="utf-8"))
                 if not name.startswith(("canopen/", "canopen_sim/", "canopen_plant/"))}
        self.assertEqual(names, set())

    def test_no_file_includes_an_old_path(self) -> None:
        old = {name_of(path) for path in sources() if module_of(path) == OLD_PATHS}
        self.assertNotEqual(old, set())
        files = [path for folder in (*TOPS, "templates", "generated", "examples", "bench", "tests", "docs", "cmake")
                 for path in sorted((SOURCE_DIR / folder).rglob("*"))
                 if path.suffix in (".cpp", ".hpp", ".mustache", ".py", ".cmake", ".md", ".tsv")]
        found = [f"{path.relative_to(SOURCE_DIR)} includes {name}" for path in files
                 for name in ANY_INCLUDE.findall(path.read_text(encoding="utf-8")) if name in old]
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
