#!/usr/bin/env python3
"""The commit in `edsc --version`: that of edsc's own working tree, and nothing without one.

    commit_test.py SOURCE_DIR [unittest arguments]
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(sys.argv[1]).resolve() / "cmake/EdscCommit.cmake"
ENVIRONMENT = {**{name: value for name, value in os.environ.items() if not name.startswith("GIT_")},
               "GIT_AUTHOR_NAME": "a", "GIT_AUTHOR_EMAIL": "a@b", "GIT_COMMITTER_NAME": "a", "GIT_COMMITTER_EMAIL": "a@b",
               "GIT_CONFIG_GLOBAL": os.devnull}


@unittest.skipUnless(shutil.which("git") and shutil.which("cmake"), "SKIPPED: no git or no cmake")
class Commit(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc commit "))
        self.addCleanup(shutil.rmtree, self.folder)
        self.sources = self.folder / "sources"
        self.sources.mkdir()
        self.file = self.sources / "file"
        self.file.write_text("text")

    def run_in(self, folder: Path, *command: object) -> str:
        return subprocess.run([*map(str, command)], cwd=folder, env=ENVIRONMENT, check=True, capture_output=True,
                              text=True).stdout

    def commit(self, folder: Path) -> str:
        self.run_in(folder, "git", "init", "-q")
        self.run_in(folder, "git", "add", "-A")
        self.run_in(folder, "git", "commit", "-qm", "all")
        return self.run_in(folder, "git", "rev-parse", "HEAD")[:12]

    def text(self) -> str:
        output = self.folder / "out/commit.hpp"
        self.run_in(self.folder, "cmake", f"-DSOURCE_DIR={self.sources}", f"-DOUTPUT={output}", "-P", SCRIPT)
        return output.read_text().removeprefix('#define EDSC_COMMIT "').removesuffix('"\n')

    def test_of_a_working_tree(self) -> None:
        head = self.commit(self.sources)
        self.assertEqual(self.text(), f" (commit {head})")
        written = (self.folder / "out/commit.hpp").stat().st_mtime_ns
        self.assertEqual(self.text(), f" (commit {head})")
        self.assertEqual((self.folder / "out/commit.hpp").stat().st_mtime_ns, written)
        self.file.write_text("changed")
        self.assertEqual(self.text(), f" (commit {head} with changes)")

    def test_of_an_archive(self) -> None:
        self.assertEqual(self.text(), "")

    def test_of_an_archive_in_the_working_tree_of_another_project(self) -> None:
        self.commit(self.folder)
        self.assertEqual(self.text(), "")

    def test_before_the_first_commit(self) -> None:
        self.run_in(self.sources, "git", "init", "-q")
        self.assertEqual(self.text(), "")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=1)
