#!/usr/bin/env python3
"""The target device_pages: for each reference device a page as HTML and as Markdown, with the product name of its EDS.

    device_pages_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE_DIR, BUILD_DIR = (Path(argument).resolve() for argument in sys.argv[1:3])
PAGES = BUILD_DIR / "docs/devices"


class DevicePages(unittest.TestCase):
    def test_each_device_has_its_pages(self) -> None:
        shutil.rmtree(PAGES, ignore_errors=True)
        built = subprocess.run(["cmake", "--build", BUILD_DIR, "--target", "device_pages"], capture_output=True, text=True,
                               timeout=1700)
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        sheets = sorted((SOURCE_DIR / "eds").glob("*.eds"))
        self.assertEqual(len(sheets), 8)
        self.assertEqual(sorted(path.name for path in PAGES.iterdir()),
                         sorted(sheet.stem + suffix for sheet in sheets for suffix in (".html", ".md")))
        for sheet in sheets:
            (product,) = re.findall(r"(?m)^ProductName=(.+?)\s*$", sheet.read_text(encoding="utf-8", errors="replace"))
            for suffix in (".html", ".md"):
                self.assertIn(product, (PAGES / (sheet.stem + suffix)).read_text(encoding="utf-8"), sheet.stem + suffix)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
