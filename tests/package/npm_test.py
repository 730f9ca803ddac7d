#!/usr/bin/env python3
"""The npm package: npm installs it from a file, and npx runs the program of this platform.

    npm_test.py SOURCE_DIR EDSC

Its archives contain EDSC in place of a static program. Exit code 77: skipped.
"""

from __future__ import annotations

import json
import os
import platform
import shutil
import signal
import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, EDSC = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
MAKE = SOURCE_DIR / "cmake/npm/make_package.py"
SHEET = SOURCE_DIR / "eds/cpd.eds"
VERSION = subprocess.run([EDSC, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
PLACES = ("share/doc/edsc/THIRD-PARTY-NOTICES", "share/doc/edsc/edsc.cdx.json", "share/doc/edsc/copyright")


def run(*command: object, folder: Path, status: int = 0) -> subprocess.CompletedProcess[str]:
    result = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, timeout=600)
    if result.returncode != status:
        raise AssertionError(f"{command}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def make_archive(folder: Path, processor: str, program: Path, version: str = VERSION) -> Path:
    top = f"edsc-{version}-linux-{processor}"
    path = folder / f"{top}.tar.gz"
    with tarfile.open(path, "w:gz") as archive:
        archive.add(program, f"{top}/bin/edsc")
        for place in PLACES:
            archive.add(SOURCE_DIR / "LICENSE", f"{top}/{place}")
    return path


class Npm(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-npm-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        other = {"x86_64": "aarch64", "aarch64": "x86_64"}[platform.machine()]
        archives = [make_archive(cls.folder, platform.machine(), EDSC), make_archive(cls.folder, other, SOURCE_DIR / "LICENSE")]
        for name in ("made", "made again"):
            run(MAKE, cls.folder / name, *archives, folder=cls.folder)
        cls.package = cls.folder / f"made/edsc-{VERSION}.tgz"
        cls.project = cls.folder / "project"
        cls.project.mkdir()
        run("npm", "install", "--offline", "--no-audit", "--no-fund", cls.package, folder=cls.project)

    def test_runs_the_program(self) -> None:
        self.assertEqual(run("npx", "--no-install", "edsc", "version", folder=self.project).stdout,
                         run(EDSC, "version", folder=self.project).stdout)

    def test_passes_arguments_output_and_exit_code(self) -> None:
        for arguments, status in ((("check", SHEET), 0), (("check", SHEET, "--format", "json"), 0), (("check", "none.eds"), 2),
                                  (("dump", SHEET, "--no-such-option"), 2)):
            results = [run(*command, *arguments, folder=self.project, status=status)
                       for command in (("npx", "--no-install", "edsc"), (EDSC,))]
            self.assertEqual(*[(result.stdout, result.stderr) for result in results])

    def test_ends_the_program_with_a_signal(self) -> None:
        """A terminal sends SIGINT to all programs of a group, a supervisor SIGTERM to the process that it has started."""
        for send, number in ((os.kill, signal.SIGTERM), (os.killpg, signal.SIGINT)):
            process = subprocess.Popen(["node", self.project / "node_modules/edsc/bin/edsc.js", "bus", "--listen", "127.0.0.1:0"],
                                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
            self.addCleanup(process.stdout.close)
            self.assertTrue(process.stdout.readline())  # the program runs
            send(process.pid, number)
            self.assertEqual(process.wait(timeout=30), 0)

    def test_names_a_platform_without_a_program(self) -> None:
        launcher = self.project / "node_modules/edsc/bin/edsc.js"
        script = f"Object.defineProperty(process, 'platform', {{ value: 'sunos' }}); require({json.dumps(str(launcher))})"
        result = run("node", "-e", script, folder=self.project, status=1)
        self.assertIn("this package does not have a program for sunos-", result.stderr)

    def test_has_license_and_notices(self) -> None:
        installed = self.project / "node_modules/edsc"
        self.assertEqual((installed / "LICENSE").read_bytes(), (SOURCE_DIR / "LICENSE").read_bytes())
        description = json.loads((installed / "package.json").read_text())
        self.assertEqual((description["version"], description["license"]), (VERSION, "MIT"))
        for name in ("linux-x64", "linux-arm64"):
            self.assertEqual({path.name for path in (installed / "programs" / name).iterdir()},
                             {"edsc", "THIRD-PARTY-NOTICES", "edsc.cdx.json"})

    def test_is_the_same_again(self) -> None:
        self.assertEqual(self.package.read_bytes(), (self.folder / f"made again/edsc-{VERSION}.tgz").read_bytes())

    def test_refuses_archives_of_two_versions(self) -> None:
        archives = [make_archive(self.folder, "x86_64", EDSC), make_archive(self.folder, "aarch64", EDSC, "99.0.0")]
        result = run(MAKE, self.folder / "none", *archives, folder=self.folder, status=1)
        self.assertIn("different versions: ", result.stderr)
        result = run(MAKE, self.folder / "none", SHEET, folder=self.folder, status=1)
        self.assertIn("expected the name edsc-VERSION-PLATFORM", result.stderr)


if __name__ == "__main__":
    if not (shutil.which("npm") and shutil.which("node")):
        print("skipped: npm is not installed")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
