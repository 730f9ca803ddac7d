#!/usr/bin/env python3
"""The documents in the package: their links have targets in the package, and a user without the sources can follow them.

    installed_documents_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
import unittest
import urllib.parse
from pathlib import Path

from consumer import BUILD_DIR, ENVIRONMENT, SOURCE_DIR, run, use_compiler_cache

sys.path.insert(0, str(SOURCE_DIR / "tests/docs"))
from docs_test import BLOCK, LINK, anchors_of  # noqa: E402

MARK = "run by: tests/package/installed_documents_test.py"


class InstalledDocuments(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp(prefix="edsc-documents-")).resolve()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.prefix = cls.folder / "usr"
        run("cmake", "--install", BUILD_DIR, "--prefix", cls.prefix)
        cls.documents = cls.prefix / "share/doc/edsc"

    def test_have_a_target_for_each_link(self) -> None:
        count, dead = 0, []
        for page in sorted(self.documents.rglob("*.md")):
            text = BLOCK.sub("", page.read_text(encoding="utf-8"))
            for name, anchor in LINK.findall(text):
                count += 1
                target = (page.parent / name).resolve() if name else page
                is_installed = target.exists() and target.is_relative_to(self.documents)
                if not is_installed or (anchor and target.suffix == ".md" and anchor not in anchors_of(target)):
                    dead.append(f"{page.relative_to(self.documents)}: {name}#{anchor}")
        self.assertEqual(dead, [])
        self.assertGreater(count, 300)

    def test_are_for_users(self) -> None:
        for name in ("docs/developers", "docs/site", "docs/api.doxygen", "CONTRIBUTING.md"):
            self.assertFalse((self.documents / name).exists(), name)

    def test_are_named_by_the_program(self) -> None:
        printed = run(self.prefix / "bin/edsc", "check", "--explain", "pdo-length")
        (file, anchor), = re.findall(r"^Documentation, with examples: file://(.*)#(.*)$", printed, re.MULTILINE)
        page = Path(urllib.parse.unquote(file))
        self.assertEqual(page, self.documents / "docs/rules.md")
        self.assertIn(anchor, anchors_of(page))
        self.assertIn("\nWrong:\n", printed)

    def test_have_examples_that_are_built_with_the_package(self) -> None:
        """The commands of docs/install.md for a user of the packages. One of the nodes is built."""
        text = (SOURCE_DIR / "docs/install.md").read_text(encoding="utf-8")
        (commands,) = [block["text"].splitlines() for block in BLOCK.finditer(text) if block["mark"] == MARK]
        use_compiler_cache(self.folder)
        path = f"{self.prefix / 'bin'}{os.pathsep}{ENVIRONMENT['PATH']}"
        self.assertTrue(commands[-1].endswith(" --target nodes"))
        commands[-1] = commands[-1].replace(" nodes", " rk5c_node first_device")
        for command in commands:
            run("bash", "-euc", command.replace("/usr/", f"{self.prefix}/"), folder=self.folder, variables={"PATH": path})
        examples = self.folder / "canopen/build/demo/examples"
        run(examples / "first_device/first_device")
        self.assertIn("rk5c", run(examples / "nodes/rk5c", "--help").lower())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
