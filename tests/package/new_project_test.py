#!/usr/bin/env python3
"""`edsc new --project` of an installed edsc: the commands of docs/how-to/write-an-eds.md, and a project for each profile.

    new_project_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

Each project compiles without a warning for Linux and for a board, its device passes the conformance test, and its image boots under
QEMU: a scan of its serial line finds the node with the identity of the EDS.
"""

from __future__ import annotations

import contextlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path

import consumer
from consumer import ENVIRONMENT, SOURCE_DIR, WITHOUT_ARM, PackageTest, run, use_compiler_cache
from document_commands import Program

PAGE = SOURCE_DIR / "docs/how-to/write-an-eds.md"
WARNINGS = "-Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wpedantic -Werror"
WITHOUT_BOARD = WITHOUT_ARM or ("" if shutil.which("qemu-system-arm") else "SKIPPED: qemu-system-arm is not installed")
SERIAL_LINE = "/dev/pts/3"  # in the document


class NewProject(PackageTest):
    def setUp(self) -> None:
        super().setUp()
        prefix = self.install()
        self.project = Path(tempfile.mkdtemp(prefix="edsc-new-project-")).resolve()
        self.addCleanup(shutil.rmtree, self.project)
        use_compiler_cache(self.project)
        self.variables = {"PATH": f"{prefix / 'bin'}:{ENVIRONMENT['PATH']}"}

    def run_line(self, line: str) -> str:
        return run("bash", "-c", line, folder=self.project, variables=self.variables)

    @contextlib.contextmanager
    def machine(self, command: str) -> Iterator[str]:
        """Starts QEMU, returns its serial line, and ends it: an image without sleep needs a whole processor."""
        machine = Program(command, self.project, ENVIRONMENT | self.variables)
        try:
            machine.wait_for("char device redirected to .*")
            (line,) = re.findall(r"/dev/pts/\d+", "\n".join(machine.lines))
            yield line
        finally:
            machine.end()

    def commands_of_the_page(self) -> list[list[str]]:
        pattern = rf"<!-- run by: tests/package/{Path(__file__).name} -->\n```sh\n(.*?)```"
        return [block.splitlines() for block in re.findall(pattern, PAGE.read_text(encoding="utf-8"), re.DOTALL)]

    @unittest.skipIf(WITHOUT_BOARD, WITHOUT_BOARD)
    def test_commands_of_the_page(self) -> None:
        make, scan = self.commands_of_the_page()
        self.assertLessEqual(len(make), 4)  # edsc new and at most three further commands
        *lines, qemu = make
        printed = [self.run_line(line) for line in lines]
        self.assertIn("pump_conforms", printed[1])
        self.assertIn("100% tests passed, 0 tests failed out of 1", printed[1])
        with self.machine(qemu.removesuffix(" &")) as serial_line:
            scanned = "".join(self.run_line(line.replace(SERIAL_LINE, serial_line) + " --timeout 5s") for line in scan)
        self.assertRegex(scanned, r"(?m)^ +5 .* pump ")

    def make_project(self, *options: str) -> None:
        self.run_line(f"edsc new d1.eds --vendor-name Acme --vendor 0x1234 --product 7 --project {' '.join(options)}")
        self.variables["CXXFLAGS"] = WARNINGS
        self.assertIn("100% tests passed, 0 tests failed out of 1", self.run_line("cmake --workflow --preset host"))
        self.run_line("edsc check --strict d1.eds")
        if WITHOUT_BOARD:
            return
        self.run_line("cmake --workflow --preset firmware")
        with self.machine("qemu-system-arm -M mps2-an385 -kernel build/firmware/d1_firmware.elf -display none -monitor none "
                          "-serial pty") as serial_line:
            read = self.run_line(f"edsc read slcan:{serial_line} 5 1018h:02 --eds d1.eds --raw --timeout 10s")
        self.assertEqual(read.split()[-4:], ["07", "00", "00", "00"])

    def test_no_profile(self) -> None:
        self.make_project()

    def test_drive_with_storage_and_lss(self) -> None:
        self.make_project("--cia 402", "--modes pp,csp", "--with-storage", "--with-lss")

    def test_never_overwrites(self) -> None:
        for name in ("CMakeLists.txt", "main.cpp", "d1.options.json"):
            (self.project / name).write_text("mine\n")
            result = subprocess.run(["edsc", "new", "d1.eds", "--vendor-name", "Acme", "--cia", "401", "--project"], cwd=self.project,
                                    env=ENVIRONMENT | self.variables, capture_output=True, text=True, check=False)
            self.assertEqual((result.returncode, result.stdout), (2, ""))
            self.assertIn(f"{name}: the file exists, and is not overwritten", result.stderr)
            self.assertEqual([path.name for path in self.project.iterdir()], [name])
            (self.project / name).unlink()

    def test_rejects_a_name_for_which_cmake_has_a_meaning(self) -> None:
        for name in ("a b.eds", "a;b.eds", "$x.eds"):
            result = subprocess.run(["edsc", "new", name, "--vendor-name", "Acme", "--project"], cwd=self.project,
                                    env=ENVIRONMENT | self.variables, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 2)
            self.assertIn("has characters other than letters, digits, _, - and .", result.stderr)
            self.assertEqual(list(self.project.iterdir()), [])


class EachProfile(NewProject):
    """The remaining combinations, for the long tests."""

    test_commands_of_the_page = test_no_profile = test_drive_with_storage_and_lss = test_never_overwrites = None
    test_rejects_a_name_for_which_cmake_has_a_meaning = None

    def test_profiles(self) -> None:
        for options in ("--cia 401", "--cia 402 --modes pp,vl,pv,tq,hm,csp,csv,cst", "--cia 404 --with-lss", "--cia 406 --with-storage",
                        "--with-storage --with-lss", "--cia 401 --tpdo-objects 6000h --rpdo-objects 6200h --heartbeat 100ms"):
            with self.subTest(options=options):
                for path in self.project.iterdir():
                    shutil.rmtree(path) if path.is_dir() else path.unlink()
                self.make_project(options)


if __name__ == "__main__":
    assert consumer.BUILD_DIR.is_dir()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
