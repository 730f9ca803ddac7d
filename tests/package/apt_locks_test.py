#!/usr/bin/env python3
"""demo.sh and test.sh wait while another program holds a lock of apt or dpkg: Debian's apt-get, in folders of its own.

    apt_locks_test.py SOURCE_DIR [unittest arguments]
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
LOCKS = ("lib/lists/lock", "dpkg/lock-frontend", "dpkg/lock", "cache/archives/lock")
CONTROL = "Package: edsc-planted\nVersion: 1\nArchitecture: all\nMaintainer: x <x@example.org>\nDescription: x\n"
# dpkg is replaced by a program that does nothing, so that apt-get needs no root.
CONFIGURATION = """\
Dir::Etc "{0}/etc";
Dir::Etc::SourceList "{0}/sources.list";
Dir::Etc::SourceParts "-";
Dir::State "{0}/lib";
Dir::State::Status "{0}/dpkg/status";
Dir::Cache "{0}/cache";
Dir::Log "{0}/log";
Dir::Bin::dpkg "/bin/true";
APT::Sandbox::User "";
Acquire::Languages "none";
"""


@unittest.skipUnless(shutil.which("apt-get") and shutil.which("dpkg-deb"), "SKIPPED: not on Debian")
class AptLocks(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory(prefix="edsc-apt-")
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name in ("etc", "lib/lists/partial", "cache/archives/partial", "dpkg", "log", "repository", "bin", "project/.ci"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "dpkg/status").touch()
        (self.folder / "apt.conf").write_text(CONFIGURATION.format(self.folder))
        (self.folder / "sources.list").write_text(f"deb [trusted=yes] file:{self.folder}/repository ./\n")
        self.add_package()
        sudo = self.folder / "bin/sudo"  # for users other than root
        sudo.write_text('#!/bin/sh\nexec "$@"\n')
        sudo.chmod(0o755)
        self.script = self.folder / "project/.ci/install-packages"
        shutil.copy(SOURCE_DIR / ".ci/install-packages", self.script)
        (self.folder / "project/packages.txt").write_text("build  edsc-planted\n")
        self.environment = os.environ | {"APT_CONFIG": str(self.folder / "apt.conf"),
                                         "PATH": f"{self.folder}/bin:{os.environ['PATH']}"}

    def add_package(self) -> None:
        repository, sources = self.folder / "repository", self.folder / "package"
        (sources / "DEBIAN").mkdir(parents=True)
        (sources / "DEBIAN/control").write_text(CONTROL)
        package = repository / "planted.deb"
        subprocess.run(["dpkg-deb", "--root-owner-group", "-b", sources, package], check=True, capture_output=True)
        data = package.read_bytes()
        (repository / "Packages").write_text(f"{CONTROL}Filename: ./planted.deb\nSize: {len(data)}\n"
                                             f"SHA256: {hashlib.sha256(data).hexdigest()}\n")

    def start(self, **environment: str) -> subprocess.Popen[str]:
        process = subprocess.Popen([self.script, "build"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   env=self.environment | environment)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.addCleanup(process.stdout.close)
        return process

    def installed(self) -> bool:
        """The log of apt has the command that installs the package."""
        log = self.folder / "log/history.log"
        return log.exists() and "Install: edsc-planted:" in log.read_text()

    def test_packages_are_installed_at_once_without_another_program(self) -> None:
        output, _ = self.start().communicate()
        self.assertEqual(output, "Installing Debian packages: edsc-planted\n")
        self.assertTrue(self.installed())

    def test_each_lock_is_awaited_with_a_message(self) -> None:
        for name in LOCKS:
            with self.subTest(name):
                (self.folder / "log/history.log").unlink(missing_ok=True)
                lock = self.folder / name
                with lock.open("w") as file:
                    fcntl.lockf(file, fcntl.LOCK_EX)
                    process = self.start()
                    self.assertEqual(process.stdout.readline(), "Installing Debian packages: edsc-planted\n")
                    message = process.stdout.readline()  # before the lock is free
                    self.assertTrue(message.startswith("Waiting for another program that installs packages: "), message)
                    self.assertIn(str(lock), message)
                    self.assertFalse(self.installed())
                output, _ = process.communicate()
                self.assertEqual((process.returncode, output), (0, ""))
                self.assertTrue(self.installed())

    def test_a_lock_that_stays_is_an_error_after_a_time(self) -> None:
        with (self.folder / "lib/lists/lock").open("w") as file:
            fcntl.lockf(file, fcntl.LOCK_EX)
            process = self.start(EDSC_LOCK_TIMEOUT="1")
            output, _ = process.communicate()
        self.assertEqual(process.returncode, 1)
        self.assertIn("E: Could not get lock", output)

    def test_another_error_is_not_awaited(self) -> None:
        (self.folder / "project/packages.txt").write_text("build  edsc-of-nobody\n")
        process = self.start()
        output, _ = process.communicate()
        self.assertEqual(process.returncode, 1)
        self.assertNotIn("Waiting for", output)
        self.assertIn("E: Unable to locate package edsc-of-nobody", output)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
