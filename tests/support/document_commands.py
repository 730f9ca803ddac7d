"""The commands of a page of docs/ that a test runs, with the output that the page shows."""

from __future__ import annotations

import re
import subprocess
import unittest
from collections.abc import Callable
from pathlib import Path


def run_document(case: unittest.TestCase, page: Path, test: str, run_line: Callable[[str], subprocess.CompletedProcess[str]],
                 min_blocks: int) -> None:
    """Runs each line of the blocks of shell commands that the page marks as run by `test`. Each line of a block that follows is in
    the output of the commands."""
    block = re.compile(rf"<!-- run by: {re.escape(test)} -->\n```(\w*)\n(.*?)```", re.DOTALL)
    blocks = block.findall(page.read_text(encoding="utf-8"))
    case.assertGreaterEqual(len(blocks), min_blocks)
    output = ""
    for language, text in blocks:
        if language == "sh":
            output = ""
            for line in text.splitlines():
                result = run_line(line)
                case.assertEqual(result.returncode, 0, f"{line}\n{result.stdout}{result.stderr}")
                output += result.stdout
        else:
            for line in text.splitlines():
                case.assertIn(line, output)
