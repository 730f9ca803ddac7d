"""The browser that tests drive, with puppeteer-core and axe-core of npm."""

from __future__ import annotations

import shutil
import sys
import unittest
from pathlib import Path

from npm_packages import Skipped, install_npm_packages

CHROMIUM = shutil.which("chromium")


def install_browser(source_dir: Path, work: Path) -> None:
    """Installs the packages and the scripts of tests/document/browser in `work`; skips the test without them or Chromium."""
    try:
        install_npm_packages(source_dir / "tests/document/browser", work)
        if CHROMIUM is None:
            raise Skipped("chromium is not installed")
    except Skipped as reason:
        print(reason, file=sys.stderr)
        raise unittest.SkipTest(str(reason)) from None
