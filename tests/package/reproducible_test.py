#!/usr/bin/env python3
"""The same inputs in two folders give the same files, byte for byte, in another time zone and language, too.

    reproducible_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, EDSC = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
LOG = "".join(f"({number}.000000) can0 705#05\n({number}.100000) can0 605#4064600000000000\n"
              f"({number}.200000) can0 585#43646000{number:02X}000000\n" for number in range(1, 9))
SHEETS = sorted(path.stem for path in (SOURCE_DIR / "eds").glob("*.eds"))
COMMANDS = (*(("generate", f"eds/{name}.eds", "-o", "out") for name in SHEETS),
            *(("generate", f"eds/{name}.eds", "-o", f"out/c/{name}", "--target", "c") for name in SHEETS),
            *(("document", f"eds/{name}.eds", "-o", f"out/{name}.{kind}") for name in SHEETS for kind in ("html", "md")),
            *(("network", "generate", f"examples/networks/{name}.json", "-o", f"out/{name}")
              for name in ("eight_devices", "four_modules", "twelve_axes")),
            ("document", "examples/networks/eight_devices.json", "-o", "out/eight_devices.html"),
            ("plot", "a.log", "5/6064h", "--node", "5=eds/cpc-tc1.eds", "-o", "out/a.svg"))
ENVIRONMENTS = ({"TZ": "UTC", "LC_ALL": "C.UTF-8"}, {"TZ": "Asia/Kathmandu", "LC_ALL": "C", "USER": "other", "HOME": "/nowhere"})


class Reproducible(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-reproducible-")
        self.addCleanup(folder.cleanup)
        self.folders = [Path(folder.name) / "first", Path(folder.name) / "another folder/second"]
        for copy in self.folders:
            shutil.copytree(SOURCE_DIR / "eds", copy / "eds")
            shutil.copytree(SOURCE_DIR / "examples", copy / "examples")
            (copy / "a.log").write_text(LOG)

    def run_commands(self, folder: Path, environment: dict[str, str], place: str = "") -> dict[str, bytes]:
        """Runs the commands in the folder; `place` precedes each path. Returns the files that they write."""
        out = folder / "out"
        for command in COMMANDS:
            words = [place + word if word.startswith(("eds/", "examples/", "out", "a.log")) else word for word in command]
            result = subprocess.run([EDSC, *words], cwd=folder, env=os.environ | environment, capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, f"{words}: {result.stdout}{result.stderr}")
        return {str(path.relative_to(out)): path.read_bytes() for path in out.rglob("*") if path.is_file()}

    def expect_same(self, left: dict[str, bytes], right: dict[str, bytes]) -> None:
        self.assertGreater(len(left), 100)
        self.assertEqual(set(left), set(right))
        self.assertEqual([name for name in left if left[name] != right[name]], [])

    def test_relative_paths(self) -> None:
        self.expect_same(*(self.run_commands(folder, environment)
                           for folder, environment in zip(self.folders, ENVIRONMENTS)))

    def test_absolute_paths(self) -> None:
        self.expect_same(*(self.run_commands(folder, environment, f"{folder}/")
                           for folder, environment in zip(self.folders, ENVIRONMENTS)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
