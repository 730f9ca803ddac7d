#!/usr/bin/env python3
"""The functions of edsc that differ on Windows pass their GoogleTests under wine.

    windows_system_test.py SOURCE_DIR [unittest arguments]

A sample of windows_test.py: the whole program takes minutes to build, its folder `system` half a minute.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import in_parallel  # noqa: E402
from support.wine import Wine, has_wine  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
COMPILER = "x86_64-w64-mingw32-g++-posix"
GOOGLETEST = Path("/usr/src/googletest/googletest")
# The other tests of the folder use POSIX. Of these, two expect rights and names that only Linux has.
TESTS = ("gzip", "input_file", "path", "temporary_folder")
ONLY_ON_LINUX = re.compile(r"list\(APPEND system_sources (system/\w+\.cpp.*?)\)")  # in generator/CMakeLists.txt
NOT_ON_WINDOWS = ("Path.KeepsItsTextFromAndToTheFileSystem", "TemporaryFolder.IsNewPrivateAndRemovedWithItsFiles")


def sources() -> list[Path]:
    """As generator/CMakeLists.txt selects them: those of system/windows instead of those of the same name."""
    folder = SOURCE_DIR / "generator/system"
    of_windows = sorted(folder.glob("windows/*.cpp"))
    only_on_linux = ONLY_ON_LINUX.search((SOURCE_DIR / "generator/CMakeLists.txt").read_text())
    assert only_on_linux
    names = {path.name for path in of_windows} | {Path(source).name for source in only_on_linux[1].split()}
    return [*of_windows, *(path for path in sorted(folder.glob("*.cpp")) if path.name not in names)]


class System(unittest.TestCase):
    def setUp(self) -> None:
        if not has_wine():
            self.skipTest("SKIPPED: wine64 is not installed")
        folder = tempfile.TemporaryDirectory(prefix="edsc-windows-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_program(self, *command: object) -> None:
        result = subprocess.run([*map(str, command)], capture_output=True, text=True, errors="replace", timeout=600)
        self.assertEqual(result.returncode, 0, f"{command}\n{result.stdout}{result.stderr}")

    def compile(self, source: Path) -> None:
        include = self.folder / "include"  # the other headers of /usr/include are those of Linux
        self.run_program(COMPILER, "-std=c++20", "-O0", "-DNOMINMAX", "-DWIN32_LEAN_AND_MEAN", "-DFMT_HEADER_ONLY", f"-I{include}",
                         f"-I{SOURCE_DIR / 'generator'}", f"-I{SOURCE_DIR / 'runtime/include'}", f"-I{GOOGLETEST / 'include'}",
                         f"-I{GOOGLETEST}", "-c", source, "-o", self.folder / f"{source.stem}.o")

    def test_under_wine(self) -> None:
        (self.folder / "include").mkdir()
        (self.folder / "include/fmt").symlink_to("/usr/include/fmt")
        tests = [SOURCE_DIR / f"tests/generator/system/{name}_test.cpp" for name in TESTS]
        all_sources = [*sources(), *tests, GOOGLETEST / "src/gtest-all.cc", GOOGLETEST / "src/gtest_main.cc"]
        in_parallel(self.compile, all_sources)
        program = self.folder / "system_tests.exe"
        self.run_program(COMPILER, "-static", "-fuse-ld=lld", *(self.folder / f"{source.stem}.o" for source in all_sources), "-lz",
                         "-o", program)
        wine = Wine()
        self.addCleanup(wine.end)
        result = wine.run(program, f"--gtest_filter=-{':'.join(NOT_ON_WINDOWS)}", cwd=self.folder)
        output = (result.stdout + result.stderr).decode(errors="replace")
        self.assertEqual(result.returncode, 0, output)
        self.assertRegex(output, r"\[  PASSED  \] (1[4-9]|[2-9]\d) tests")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
