#!/usr/bin/env python3
"""The pictures of docs/pictures are those that docs/pictures/make.py draws, well-formed and with a title or a label.

    pictures_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

SVG = "{http://www.w3.org/2000/svg}"


def main() -> int:
    pictures, edsc = Path(sys.argv[1]).resolve() / "docs/pictures", sys.argv[2]
    problems = []
    with tempfile.TemporaryDirectory() as temporary:
        subprocess.run([pictures / "make.py", edsc, temporary], check=True)
        drawn = {path.name: path.read_bytes() for path in Path(temporary).iterdir()}
    kept = {path.name: path.read_bytes() for path in pictures.glob("*.svg")}
    for name in sorted(drawn.keys() | kept.keys()):
        if drawn.get(name) != kept.get(name):
            problems.append(f"docs/pictures/{name} is not current: docs/pictures/make.py EDSC docs/pictures")
        root = ET.fromstring(drawn.get(name, b"<svg/>"))
        if root.tag != f"{SVG}svg" or (root.find(f"{SVG}title") is None and "aria-label" not in root.attrib):
            problems.append(f"{name} does not have a title")
    print("\n".join(problems))
    print(f"{len(drawn)} pictures, {len(problems)} problems")
    return 1 if problems or not drawn else 0


if __name__ == "__main__":
    sys.exit(main())
