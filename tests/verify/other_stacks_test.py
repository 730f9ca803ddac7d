#!/usr/bin/env python3
"""The figures of other stacks on docs/footprint.md: each has a row, and the lowest one is shown.

    other_stacks_test.py SOURCE_DIR
"""

from __future__ import annotations

import json
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

SOURCE_DIR = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "bench/footprint"))
import other_stacks  # noqa: E402
from other_stacks import BYTES, MODM, NODE, Other  # noqa: E402

FLASH, RAM = "flash, static mapping", "RAM, static mapping"


class OtherStacks(unittest.TestCase):
    def test_every_figure_has_a_row(self) -> None:
        page = (SOURCE_DIR / "docs/footprint.md").read_text(encoding="utf-8")
        rows = {line.split(" | ")[0].removeprefix("| ") for line in page.splitlines() if line.startswith("| ")}
        for figures in (other_stacks.QUOTED, *(made["figures"] for made in other_stacks.rebuilt().values())):
            for kind, found in figures.items():
                self.assertLessEqual(set(found), rows, kind)

    def test_the_page_names_the_rebuilt_stacks(self) -> None:
        page = (SOURCE_DIR / "docs/footprint.md").read_text(encoding="utf-8")
        self.assertIn(other_stacks.rebuilt_text(), page)


class Best(unittest.TestCase):
    def best(self, row: str, **rebuilt: float) -> Other | None:
        """The best figure if these stacks were rebuilt."""
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(other_stacks, "REBUILT", Path(folder) / "peers.json"):
            other_stacks.REBUILT.write_text(json.dumps(
                {stack: {"figures": {BYTES: {row: value}}} for stack, value in rebuilt.items()}), encoding="utf-8")
            return other_stacks.best(BYTES, row)

    def test_without_a_rebuilt_stack(self) -> None:
        self.assertEqual(self.best(FLASH), Other(NODE, 11808, is_quoted=True))

    def test_a_rebuilt_figure_replaces_the_quoted_one_of_its_stack(self) -> None:
        self.assertEqual(self.best(FLASH, CANopenNode=12000), Other(NODE, 12000, is_quoted=False))

    def test_the_quoted_figure_of_another_stack_is_lower(self) -> None:
        self.assertEqual(self.best(RAM, CANopenNode=3000), Other(MODM, 1016, is_quoted=True))

    def test_a_row_without_a_figure(self) -> None:
        self.assertIsNone(self.best("no row"))

    def test_an_update_keeps_the_other_stacks(self) -> None:
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(other_stacks, "REBUILT", Path(folder) / "peers.json"):
            other_stacks.update("one", {"date": "2026-01-01"})
            other_stacks.update("two", {"date": "2026-01-02"})
            other_stacks.update("one", {"date": "2026-01-03"})
            self.assertEqual(other_stacks.rebuilt(), {"one": {"date": "2026-01-03"}, "two": {"date": "2026-01-02"}})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
