#!/usr/bin/env python3
"""The section "One value and one frame" of docs/developers/architecture.md names files and their functions as they are.

    walkthrough_test.py SOURCE_DIR

Each row of its tables has a link to a file, and names that the file must contain: `Class::function` stands for both.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

SECTION = re.compile(r"^## One value and one frame$(.*?)^## ", re.MULTILINE | re.DOTALL)
ROW = re.compile(r"^\|.*\| \[[^]]*\]\((?P<file>[^)]*)\) \| (?P<names>.*) \|$", re.MULTILINE)
NAME = re.compile(r"`([\w:]+)`")


def problems_of(file: Path, names: list[str]) -> list[str]:
    if not file.is_file():
        return [f"{file} does not exist"]
    text = file.read_text(encoding="utf-8")
    words = [word for name in names for word in name.split("::")]
    return [f"{file} does not contain {word}" for word in words if not re.search(rf"\b{word}\b", text)]


def main() -> int:
    document = Path(sys.argv[1]).resolve() / "docs/developers/architecture.md"
    section = SECTION.search(document.read_text(encoding="utf-8"))
    rows = list(ROW.finditer(section[1])) if section else []
    problems = [] if rows else [f"{document} does not have the tables"]
    for row in rows:
        names = NAME.findall(row["names"])
        problems += problems_of((document.parent / row["file"]).resolve(), names) if names else [f"no names: {row[0]}"]
    print("\n".join(problems))
    print(f"{len(rows)} steps, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
