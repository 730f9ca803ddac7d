#!/usr/bin/env python3
"""docs/examples.md has a row for each folder of examples/, and its targets exist.

    examples_test.py SOURCE_DIR BUILD_DIR
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

SOURCE_DIR, BUILD_DIR = (Path(argument).resolve() for argument in sys.argv[1:3])
ROW = re.compile(r"^\| \[(\w+)\]\(\.\./examples/[^)]*\) \| .* \| (.*) \|$", re.MULTILINE)


def main() -> int:
    rows = dict(ROW.findall((SOURCE_DIR / "docs/examples.md").read_text(encoding="utf-8")))
    folders = {path.name for path in (SOURCE_DIR / "examples").iterdir() if path.is_dir()}
    problems = [f"docs/examples.md: no row for examples/{name}" for name in sorted(folders - rows.keys())]
    problems += [f"docs/examples.md: examples/{name} does not exist" for name in sorted(rows.keys() - folders)]
    targets = subprocess.run(["ninja", "-C", BUILD_DIR, "-t", "targets", "all"], capture_output=True, text=True, check=True).stdout
    programs = {Path(line.split(":")[0]).name for line in targets.splitlines()}
    lists = "\n".join(path.read_text(encoding="utf-8") for path in (SOURCE_DIR / "examples").rglob("CMakeLists.txt"))
    for name, cell in rows.items():
        for code in re.findall(r"`([^`]*)`", cell):
            word = code.split()[0]
            if re.fullmatch(r"\w+", word) and word not in programs and not re.search(rf"\b{word}\b", lists):
                problems.append(f"docs/examples.md: examples/{name}: there is no target {word}")
    print("\n".join(problems))
    print(f"{len(rows)} examples, {len(problems)} problems")
    return 1 if problems or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
