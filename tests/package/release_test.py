#!/usr/bin/env python3
"""The packages of the static programs: an archive and Debian packages for each processor. Their programs need no library; in an
empty folder as root of the file system they write what the program of the build does. Builds of a commit in two folders give
the same bytes.

    release_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

`./test.sh long` makes the packages as docs/install.md says. Programs for Arm run under qemu-user-static. Needs root for chroot,
else it does not run the programs. npm installs the schema of CycloneDX in WORK_DIR.
"""

from __future__ import annotations

import gzip
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

SOURCE_DIR, EDSC, WORK = (Path(argument).resolve() for argument in sys.argv[1:4])
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from cyclonedx_schema import CycloneDx  # noqa: E402
from npm_packages import Skipped  # noqa: E402

VERSION = subprocess.run([EDSC, "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
COMMANDS = (("check", "{sheet}"), ("check", "{sheet}", "--format", "sarif"), ("dump", "{sheet}"),
            ("generate", "{sheet}", "-o", "{out}"), ("document", "{sheet}", "-o", "{out}/{name}.html"),
            ("format", "{sheet}", "-o", "{out}/{name}.eds"), ("decode", "{log}", "--node", "5={sheet}"))
LOG = "(1.000000) can0 705#00\n(1.100000) can0 605#4064600000000000\n(1.200000) can0 585#4364600001000000\n"
LONGEST = 10000  # s


@dataclass(frozen=True)
class Platform:
    preset: str
    processor: str     # in the name of the archive
    architecture: str  # of Debian
    machine: str       # in the ELF header, as readelf prints it
    emulator: Path | None = None

    @property
    def top(self) -> str:
        """The folder of the archive."""
        return f"edsc-{VERSION}-linux-{self.processor}"

    def archive(self, source: Path = SOURCE_DIR) -> Path:
        return source / f"build/{self.preset}/{self.top}.tar.gz"

    def debian_packages(self, source: Path = SOURCE_DIR) -> list[Path]:
        folder = source / f"build/{self.preset}"
        return [folder / f"edsc_{VERSION}_{self.architecture}.deb", folder / f"libedsc-dev_{VERSION}_all.deb"]


PLATFORMS = (Platform("static", "x86_64", "amd64", "Advanced Micro Devices X86-64"),
             Platform("static-arm64", "aarch64", "arm64", "AArch64", Path("/usr/bin/qemu-aarch64-static")))


def output(*command: object, folder: Path | None = None, variables: dict[str, str] | None = None) -> str:
    result = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, timeout=LONGEST, cwd=folder, env=os.environ | (variables or {}))
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {result.returncode}\n{result.stdout[-4000:]}")
    return result.stdout


def run(root: Path | None, command: list[str], *arguments: str) -> tuple[int, str, str]:
    enter = (lambda: (os.chroot(root), os.chdir("/"))) if root else None
    result = subprocess.run([*command, *arguments], capture_output=True, text=True, timeout=600, preexec_fn=enter,
                            cwd=None if root else "/")
    return result.returncode, result.stdout, result.stderr


class Packages(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-release-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def unpacked(self, platform: Platform) -> Path:
        """Unpacks the archive, once in a test, and returns its folder."""
        folder = self.folder / platform.top
        if not folder.exists():
            output("tar", "-xzf", platform.archive(), "-C", self.folder)
        return folder

    def test_programs_need_no_library(self) -> None:
        for platform in PLATFORMS:
            headers = output("readelf", "-hld", self.unpacked(platform) / "bin/edsc")
            self.assertRegex(headers, rf"Machine: +{platform.machine}\n")
            self.assertNotIn("(NEEDED)", headers)
            self.assertNotIn("INTERP", headers)
            self.assertIn("DYNAMIC", headers, "the program has a random address")

    def test_archives_have_the_files_of_a_prefix(self) -> None:
        for platform in PLATFORMS:
            prefix = self.unpacked(platform)
            for name in ("doc/edsc/README.md", "doc/edsc/copyright", "edsc/schema/options.schema.json",
                         "cmake/edsc/edscConfig.cmake"):
                self.assertTrue((prefix / "share" / name).is_file(), name)
            self.assertTrue((prefix / "include/edsc/canopen/node.hpp").is_file())
            for name, command in (("bash-completion/completions/edsc", "bash"), ("zsh/site-functions/_edsc", "zsh")):
                self.assertEqual((prefix / "share" / name).read_text(), output(EDSC, "completion", command))
            self.assertEqual(gzip.decompress((prefix / "share/man/man1/edsc.1.gz").read_bytes()).decode(),
                             output(EDSC, "completion", "man"))

    def test_archives_are_sorted_and_have_one_time_and_owner(self) -> None:
        for platform in PLATFORMS:
            rows = [line.split(maxsplit=5) for line in output("tar", "-tvzf", platform.archive()).splitlines()]
            names = [row[5] for row in rows]
            self.assertEqual(names, sorted(names, key=lambda name: name.rstrip("/").split("/")))
            self.assertEqual({row[1] for row in rows}, {"0/0"})
            self.assertEqual(len({(row[3], row[4]) for row in rows}), 1)

    def test_have_notices_and_a_bill_of_materials(self) -> None:
        try:
            schema = CycloneDx(WORK)
        except Skipped as reason:
            self.skipTest(str(reason))
        for platform in PLATFORMS:
            documents = self.unpacked(platform) / "share/doc/edsc"
            bill = json.loads((documents / "edsc.cdx.json").read_text())
            self.assertEqual(schema.problems(bill), [])
            components = {component["name"]: component for component in bill["components"]}
            self.assertEqual({component["properties"][0]["value"] for component in components.values()}, {"yes"})
            (libc,) = output("dpkg-query", "-W", "-f", "${Version}\n", "libc6-dev").splitlines()
            self.assertEqual(components["GNU C Library"]["version"], libc.split("-")[0])
            self.assertEqual(components["libstdc++ and libgcc"]["version"], output("g++", "-dumpfullversion").strip())
            notices = (documents / "THIRD-PARTY-NOTICES").read_text()
            for name in ("LGPL-2.1", "LGPL-3", "GPL-3"):
                self.assertIn(Path("/usr/share/common-licenses", name).read_text(), notices)
            self.assertNotIn("The copyright notices and the license are at", notices)

    @unittest.skipUnless(shutil.which("npm"), "npm is not installed")
    def test_the_npm_package_has_the_programs(self) -> None:
        """The command is the one of docs/install.md."""
        text = (SOURCE_DIR / "docs/install.md").read_text(encoding="utf-8").split("\n## npm\n")[1]
        output("bash", "-euc", text.split("```sh\n")[1].split("```")[0], folder=SOURCE_DIR)
        output("tar", "-xzf", SOURCE_DIR / f"build/npm/edsc-{VERSION}.tgz", "-C", self.folder)
        for platform, name in zip(PLATFORMS, ("linux-x64", "linux-arm64")):
            prefix, programs = self.unpacked(platform), self.folder / "package/programs" / name
            for file, place in (("edsc", "bin"), ("THIRD-PARTY-NOTICES", "share/doc/edsc"), ("edsc.cdx.json", "share/doc/edsc")):
                self.assertEqual((programs / file).read_bytes(), (prefix / place / file).read_bytes())

    @unittest.skipIf(os.geteuid() != 0, "not root")
    def test_debian_packages_are_installed_without_other_packages(self) -> None:
        """libedsc-dev needs edsc for the processor of the machine: this machine's dpkg does not install it for another one."""
        native = output("dpkg", "--print-architecture").strip()
        for platform in PLATFORMS:
            program, development = platform.debian_packages()
            self.assertNotIn("Depends", output("dpkg-deb", "-f", program))
            packages = [program, development] if platform.architecture == native else [program]
            root = self.folder / platform.architecture
            for folder in ("info", "updates"):
                (root / "var/lib/dpkg" / folder).mkdir(parents=True)
            for name in ("status", "available"):
                (root / "var/lib/dpkg" / name).touch()
            output("dpkg", f"--root={root}", "--force-architecture", "-i", *packages)
            installed = output("dpkg-query", f"--admindir={root}/var/lib/dpkg", "-W", "-f",
                               "${Package} ${Architecture} ${db:Status-Status}\n").splitlines()
            self.assertEqual(installed, [f"edsc {platform.architecture} installed", "libedsc-dev all installed"][:len(packages)])
            self.assertEqual((root / "usr/bin/edsc").read_bytes(), (self.unpacked(platform) / "bin/edsc").read_bytes())

    @unittest.skipIf(os.geteuid() != 0, "not root")
    def test_programs_run_in_an_empty_root(self) -> None:
        for platform in PLATFORMS:
            with self.subTest(platform=platform.preset):
                self.check_programs(self.unpacked(platform) / "bin/edsc", platform)

    def check_programs(self, program: Path, platform: Platform) -> None:
        root, reference = self.folder / f"root-{platform.preset}", self.folder / f"reference-{platform.preset}"
        for place in (root, reference):
            (place / "out").mkdir(parents=True)
            (place / "a.log").write_text(LOG)
            shutil.copytree(SOURCE_DIR / "eds", place / "eds")
        shutil.copy(program, root / "edsc")
        shutil.copy(EDSC, reference / "edsc")  # the findings in SARIF name the documents beside the program, here none
        command = ["/edsc"]
        if platform.emulator:
            shutil.copy(platform.emulator, root / "emulator")
            command.insert(0, "/emulator")
        for sheet in sorted((SOURCE_DIR / "eds").glob("*.eds")):
            for arguments in COMMANDS:
                with self.subTest(sheet=sheet.name, command=arguments[0]):
                    expected, got = (
                        run(where, words, *(word.format(sheet=f"{at}/eds/{sheet.name}", out=f"{at}/out", log=f"{at}/a.log",
                                                        name=sheet.stem) for word in arguments))
                        for where, words, at in ((None, [str(reference / "edsc")], str(reference)), (root, command, "")))
                    self.assertEqual([part.replace(str(reference), "") if isinstance(part, str) else part for part in expected],
                                     list(got))
        files = {path.relative_to(place) for place in (root, reference) for path in (place / "out").rglob("*") if path.is_file()}
        self.assertGreater(len(files), 20)
        for name in files:
            self.assertEqual((root / name).read_text().replace(str(reference), ""),
                             (reference / name).read_text().replace(str(reference), ""), name)


class Reproducible(unittest.TestCase):
    @unittest.skipUnless((SOURCE_DIR / ".git").exists(), "not a git working tree")
    def test_two_folders_give_the_same_packages(self) -> None:
        """The second folder has a longer path, and its program for this processor is compiled without a compiler cache."""
        with tempfile.TemporaryDirectory(prefix="edsc-release-") as folder:
            copies = [Path(folder) / "first", Path(folder) / "another folder" / "second"]
            for copy in copies:
                output("git", "clone", "--quiet", SOURCE_DIR, copy)
                for platform in PLATFORMS:
                    cached = copy == copies[0] or platform.emulator
                    output("cmake", "--workflow", "--preset", platform.preset, folder=copy,
                           variables={} if cached else {"CCACHE_DISABLE": "1"})
            for platform in PLATFORMS:
                first, second = ([platform.archive(copy), *platform.debian_packages(copy)] for copy in copies)
                for left, right in zip(first, second):
                    self.assertEqual(output("sha256sum", left).split()[0], output("sha256sum", right).split()[0], left.name)
                programs = [copy / f"build/{platform.preset}/generator/edsc" for copy in copies]
                self.assertEqual(programs[0].read_bytes(), programs[1].read_bytes(), platform.preset)
                self.assertNotIn(str(copies[0]).encode(), programs[0].read_bytes())
            development = [platform.debian_packages(copies[0])[1].read_bytes() for platform in PLATFORMS]
            self.assertEqual(development[0], development[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
