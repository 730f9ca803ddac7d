#!/usr/bin/env python3
"""generated/ is, byte for byte, the output of edsc for the reference devices, independent of the working directory.

    golden_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import difflib
import subprocess
import sys
import tempfile
from pathlib import Path

DIFFERENCE_LINES = 12


def generate(edsc: Path, sheet: str, output: str, folder: Path) -> None:
    subprocess.run([edsc, "generate", sheet, "-o", output, "--color", "never"], cwd=folder, check=True)


def contents(root: Path) -> dict[str, bytes]:
    return {str(path.relative_to(root)): path.read_bytes() for path in sorted(root.rglob("*")) if path.is_file()}


def excerpt(committed: bytes, made: bytes) -> str:
    before, after = (text.decode(errors="replace").splitlines() for text in (committed, made))
    lines = difflib.unified_diff(before, after, "committed", "generated now", lineterm="", n=0)
    return "\n".join("    " + line for _, line in zip(range(DIFFERENCE_LINES), lines))


def compare(committed: dict[str, bytes], made: dict[str, bytes], command: str) -> list[str]:
    problems = []
    for name in sorted(committed.keys() | made.keys()):
        if name not in made:
            problems.append(f"generated/{name}: not generated from any EDS: delete it")
        elif name not in committed:
            problems.append(f"generated/{name}: missing; update with: {command}")
        elif committed[name] != made[name]:
            difference = excerpt(committed[name], made[name])
            problems.append(f"generated/{name}: differs; update with: {command}\n{difference}")
    return problems


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    sheets = sorted(path.name for path in (source_dir / "eds").glob("*.eds"))
    problems = [] if sheets else ["eds/ has no EDS"]
    with tempfile.TemporaryDirectory() as temporary:
        scratch = Path(temporary)
        for sheet in sheets:
            generate(edsc, f"eds/{sheet}", str(scratch / "relative"), source_dir)
            generate(edsc, str(source_dir / "eds" / sheet), "absolute", scratch)
        relative, absolute = contents(scratch / "relative"), contents(scratch / "absolute")
    problems += compare(contents(source_dir / "generated"), relative, "tests/golden/regenerate.sh " + str(edsc))
    problems += [f"{name}: differs if edsc is called with an absolute path from another folder"
                 for name in sorted(relative) if absolute.get(name) != relative[name]]
    print("\n".join(problems) if problems else f"{len(relative)} files of {len(sheets)} devices are the output of edsc")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
