#!/usr/bin/env python3
"""The build fails for firmware that exceeds its limits or needs a heap, and reports the reason.

    budget_test.py EDSC
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, Project

EDSC = Path(sys.argv[1]).resolve()
SHEET = SOURCE_DIR / "examples/first_device/pump.eds"
MAIN = SOURCE_DIR / "examples/firmware/main.cpp"
ON_THE_HEAP = {
    "malloc": "#include <cstdlib>\nchar* volatile p;\nint main() { p = static_cast<char*>(std::malloc(8)); }\n",
    "new": "int* volatile p;\nint main() { p = new int{5}; }\n",
    "string": "#include <string>\nstd::string text;\nint main() { text += \"a text that is long enough for the heap\"; }\n",
}


class Budget(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-budget-")
        cls.addClassCleanup(folder.cleanup)
        cls.project = Project(Path(folder.name), EDSC)
        for name, text in ON_THE_HEAP.items():
            (cls.project.folder / f"{name}.cpp").write_text(text)
        common = f'EDS "{SHEET}" BOARD microbit NODE_ID 5 SOURCES'
        cls.project.configure("\n".join([
            f'edsc_add_firmware(fits {common} "{MAIN}" FLASH_LIMIT 20000 RAM_LIMIT 2000)',
            f'edsc_add_firmware(with_lto {common} "{MAIN}")',
            f'edsc_add_firmware(without_lto {common} "{MAIN}" NO_LTO)',
            f'edsc_add_firmware(much_flash {common} "{MAIN}" FLASH_LIMIT 5000 RAM_LIMIT 2000)',
            f'edsc_add_firmware(much_ram {common} "{MAIN}" FLASH_LIMIT 20000 RAM_LIMIT 100)',
            *(f"edsc_add_firmware(heap_{name} {common} {name}.cpp)" for name in ON_THE_HEAP)]))

    def refused(self, target: str) -> str:
        result = self.project.build(target)
        self.assertNotEqual(result.returncode, 0, result.stdout)
        return result.stdout

    def test_within_its_limits(self) -> None:
        result = self.project.build("fits")
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertRegex(result.stdout, r"fits\.elf: \d+ bytes of flash \(limit 20000\), \d+ bytes of RAM \(limit 2000\)")
        report = (self.project.build_dir / "fits.report.txt").read_text()
        self.assertRegex(report, r"\nflash: \d+ of objects, \d+ shared by them \(.*\), \d+ of code and its data, \d+ between\n")

    def test_is_smaller_when_it_is_optimised_by_the_linker(self) -> None:
        flash = {}
        for target in ("with_lto", "without_lto"):
            result = self.project.build(target)
            self.assertEqual(result.returncode, 0, result.stdout)
            report = (self.project.build_dir / f"{target}.report.txt").read_text()
            flash[target] = int(re.match(r"\S+: (\d+) bytes of flash", report)[1])
        self.assertLess(flash["with_lto"], flash["without_lto"])

    def test_too_much_flash(self) -> None:
        told = self.refused("much_flash")
        self.assertRegex(told, r"error: much_flash\.elf has \d+ bytes of flash, \d+ more than its limit of 5000\n"
                               r"largest in flash:\n( +\d+  \S+\n)* +\d+  canopen::[\w:]+\n")
        largest = told.split("largest in flash:\n")[1].split("the largest objects of the EDS:")[0].splitlines()
        sizes = [int(line.split()[0]) for line in largest]
        self.assertEqual(sizes, sorted(sizes, reverse=True))
        self.assertRegex(told, r"the largest objects of the EDS:\n  object  flash     RAM\n(  [0-9A-F]{4}h +\d+ +\d+\n)+")
        self.assertRegex(told, r"\n  2000h +\d+ +2\n")
        self.assertNotIn("bytes of RAM, ", told)

    def test_too_much_ram(self) -> None:
        told = self.refused("much_ram")
        self.assertRegex(told, r"error: much_ram\.elf has \d+ bytes of RAM, \d+ more than its limit of 100\n"
                               r"largest in RAM:\n( +\d+  \S+\n)* +\d+  node\n")
        self.assertNotIn("bytes of flash, ", told)

    def test_an_image_over_its_limit_is_built_again(self) -> None:
        for attempt in ("first", "second"):
            with self.subTest(attempt):
                self.assertIn("more than its limit of 5000", self.refused("much_flash"))

    def test_nothing_links_with_a_heap(self) -> None:
        for name in ON_THE_HEAP:
            with self.subTest(name):
                told = self.refused(f"heap_{name}")
                self.assertRegex(told, r"undefined reference to `(__wrap_malloc|operator new|std::)")
                self.assertFalse((self.project.build_dir / f"heap_{name}.elf").exists())


class Optimisation(unittest.TestCase):
    """Checks the commands that compile an image, without building it."""

    def configure(self, *options: str, build_type: str) -> tuple[str, set[str]]:
        """Returns the output of CMake and the -O options of all sources for the board."""
        folder = tempfile.TemporaryDirectory(prefix="edsc-optimisation-")
        self.addCleanup(folder.cleanup)
        project = Project(Path(folder.name), EDSC)
        told = project.configure(f'edsc_add_firmware(pump EDS "{SHEET}" BOARD microbit NODE_ID 5 SOURCES "{MAIN}")',
                                 "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options, build_type=build_type)
        commands = json.loads((project.build_dir / "compile_commands.json").read_text())
        self.assertIn(str(MAIN), [command["file"] for command in commands])
        return told, {" ".join(re.findall(r" (-O\w*)", command["command"])) for command in commands}

    def test_is_for_size_where_nobody_chose_one(self) -> None:
        told, optimisation = self.configure(build_type="")
        self.assertEqual(optimisation, {"-Os"})
        self.assertIn("CMAKE_BUILD_TYPE is not set: images are compiled with -Os", told)

    def test_is_that_of_the_build_type(self) -> None:
        told, optimisation = self.configure("-DCMAKE_CXX_FLAGS_MINSIZEREL=-O1", build_type="MinSizeRel")
        self.assertEqual(optimisation, {"-O1"})
        self.assertNotIn("CMAKE_BUILD_TYPE", told)

    def test_is_that_of_the_flags(self) -> None:
        self.assertEqual(self.configure("-DCMAKE_CXX_FLAGS=-O2", build_type="")[1], {"-O2"})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
