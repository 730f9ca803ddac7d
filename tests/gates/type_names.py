#!/usr/bin/env python3
"""No two files define a type of one name.

    type_names.py SOURCE_DIR

Where a program has two, the linker keeps the functions of one of them for both. ctags lists the types of all sources, of the
tests and of the generated code, which are more than one program: a name that two programs define differently is confusing in
any case. Types of anonymous namespaces and of functions are not compared, nor are specializations of a template.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

FOLDERS = ("runtime", "generator", "bus", "cli", "generated", "examples", "bench", "tests")
# Each file is a program of its own, which is not linked with any other.
PROGRAMS_OF_ONE_FILE = ("tests/compile_fail/", "bench/safety/")
# Files that a program includes in place of another one, which it replaces.
REPLACEMENTS = {
    "tests/support/access_probe.hpp": "CANOPEN_ACCESS_PROBE names it in place of that of the runtime",
    "tests/runtime/time/wide_clock/canopen/base/clock.hpp": "the clock of 64 bits of the twin, in a program of its own",
}


def types_in(source_dir: Path) -> list[dict[str, str]]:
    """Returns the types that ctags finds, each with name, path, line and the text of its definition."""
    run = subprocess.run(["ctags", "-R", "--languages=C++", "--langmap=C++:.cpp.hpp", "--c++-kinds=csug", "--fields=+nsSZ",
                          "--output-format=json", "-f", "-", *FOLDERS], cwd=source_dir, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def is_compared(row: dict[str, str]) -> bool:
    scope = row.get("scope", "")
    is_local = row.get("scopeKind") == "function"
    is_specialization = f"{row['name']}<" in row.get("pattern", "").replace(f"{row['name']} <", f"{row['name']}<")
    return not ("__anon" in scope + row["name"] or is_local or is_specialization or row["path"] in REPLACEMENTS
                or row["path"].startswith(PROGRAMS_OF_ONE_FILE))


def main() -> int:
    places: dict[str, dict[str, str]] = defaultdict(dict)
    rows = types_in(Path(sys.argv[1]).resolve())
    for row in filter(is_compared, rows):
        places["::".join(filter(None, (row.get("scope"), row["name"])))][row["path"]] = f"{row['path']}:{row.get('line')}"
    twice = {name: found for name, found in places.items() if len(found) > 1}
    for name, found in sorted(twice.items()):
        print(f"{name} is defined in {' and '.join(found.values())}")
    print(f"{len(places)} types, {len(twice)} with two definitions")
    return 1 if twice or not places else 0


if __name__ == "__main__":
    sys.exit(main())
