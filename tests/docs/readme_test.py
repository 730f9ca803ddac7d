#!/usr/bin/env python3
"""README.md is short, and its figures are those of docs/footprint.md and docs/images.md.

    readme_test.py SOURCE_DIR
"""

from __future__ import annotations

import re
import sys
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
README = (SOURCE_DIR / "README.md").read_text(encoding="utf-8")
MAX_LINES = 150


def rows_of(text: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")]


class Readme(unittest.TestCase):
    figures = README.split("\n## Figures\n")[1].split("\n## ")[0]

    def test_is_short(self) -> None:
        self.assertLessEqual(len(README.splitlines()), MAX_LINES)

    def test_has_the_figures_of_a_device(self) -> None:
        measured = {row[0]: row for row in rows_of((SOURCE_DIR / "docs/footprint.md").read_text(encoding="utf-8")) if len(row) == 5}
        head, _, *rows = rows_of(self.figures)
        self.assertEqual(head, ["bytes", "edsc", "best other stack", "ratio"])
        self.assertGreaterEqual(len(rows), 4)
        for name, edsc, other, ratio in rows:
            self.assertEqual((edsc, other, ratio), (measured[name][1], *measured[name][3:]), name)

    def test_has_the_figures_of_an_image(self) -> None:
        (found,) = re.findall(r"\(`(\w+)`\), with .* takes (\d+) bytes of flash, (\d+)\s+of RAM and (\d+) of stack", self.figures,
                              re.DOTALL)
        images = {row[0]: row for row in rows_of((SOURCE_DIR / "docs/images.md").read_text(encoding="utf-8"))}
        self.assertEqual(list(found[1:]), images[f"`{found[0]}`"][1:4])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
