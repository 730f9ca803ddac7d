#!/usr/bin/env python3
"""The static program needs no library: in an empty folder as root of the file system it writes what the program of the build does.

    static_test.py SOURCE_DIR EDSC STATIC_EDSC

`./test.sh long` builds STATIC_EDSC as docs/install.md says. Needs root for chroot, else it only looks at the program.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, EDSC, STATIC = (Path(argument).resolve() for argument in sys.argv[1:4])
COMMANDS = (("check", "{sheet}"), ("check", "{sheet}", "--format", "sarif"), ("dump", "{sheet}"),
            ("generate", "{sheet}", "-o", "{out}"), ("document", "{sheet}", "-o", "{out}/{name}.html"),
            ("format", "{sheet}", "-o", "{out}/{name}.eds"), ("decode", "{log}", "--node", "5={sheet}"))
LOG = "(1.000000) can0 705#00\n(1.100000) can0 605#4064600000000000\n(1.200000) can0 585#4364600001000000\n"


def run(root: Path | None, program: str | Path, *arguments: str) -> tuple[int, str, str]:
    enter = (lambda: (os.chroot(root), os.chdir("/"))) if root else None
    result = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=600, preexec_fn=enter,
                            cwd=None if root else "/")
    return result.returncode, result.stdout, result.stderr


class Static(unittest.TestCase):
    def test_needs_no_library(self) -> None:
        headers = subprocess.run(["readelf", "-ld", STATIC], capture_output=True, text=True, check=True).stdout
        self.assertNotIn("(NEEDED)", headers)
        self.assertNotIn("INTERP", headers)
        self.assertIn("DYNAMIC", headers, "the program has a random address")

    @unittest.skipIf(os.geteuid() != 0, "not root")
    def test_runs_in_an_empty_root(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root, reference = Path(folder) / "root", Path(folder) / "reference"
            for place in (root, reference):
                (place / "out").mkdir(parents=True)
                (place / "a.log").write_text(LOG)
                shutil.copytree(SOURCE_DIR / "eds", place / "eds")
            shutil.copy(STATIC, root / "edsc")
            for sheet in sorted((SOURCE_DIR / "eds").glob("*.eds")):
                for command in COMMANDS:
                    with self.subTest(sheet=sheet.name, command=command[0]):
                        expected, got = (
                            run(where, program, *(word.format(sheet=f"{at}/eds/{sheet.name}", out=f"{at}/out", log=f"{at}/a.log",
                                                              name=sheet.stem) for word in command))
                            for where, program, at in ((None, EDSC, str(reference)), (root, "/edsc", "")))
                        self.assertEqual([part.replace(str(reference), "") if isinstance(part, str) else part for part in expected],
                                         list(got))
            files = {path.relative_to(place) for place in (root, reference) for path in (place / "out").rglob("*") if path.is_file()}
            self.assertGreater(len(files), 20)
            for name in files:
                self.assertEqual((root / name).read_text().replace(str(reference), ""),
                                 (reference / name).read_text().replace(str(reference), ""), name)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
