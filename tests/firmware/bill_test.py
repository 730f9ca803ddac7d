#!/usr/bin/env python3
"""The bill of materials of an image has the hashes that sha256sum prints, and the versions of the installed packages.

    bill_test.py EDSC WORK_DIR

npm installs the schema of CycloneDX in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, Project

EDSC, WORK = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from cyclonedx_schema import CycloneDx  # noqa: E402
from npm_packages import Skipped  # noqa: E402

LINES = f'edsc_add_firmware(pump EDS pump.eds BOARD microbit NODE_ID 5 SOURCES "{SOURCE_DIR}/examples/firmware/main.cpp")'
COMPILER = "arm-none-eabi-g++"


def output(*command: object) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, timeout=60).stdout


def sha256sum(path: Path) -> list[dict[str, str]]:
    return [{"alg": "SHA-256", "content": output("sha256sum", path).split()[0]}]


class Bill(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory(prefix="edsc-bill-")
        cls.addClassCleanup(folder.cleanup)
        cls.projects = []
        for name in ("first", "second"):
            project = Project(Path(folder.name) / name, EDSC)
            project.folder.mkdir()
            shutil.copy(SOURCE_DIR / "examples/first_device/pump.eds", project.folder)
            (project.folder / "pump.options.json").write_text("{}\n")
            project.configure(LINES)
            result = project.build("pump")
            if result.returncode != 0:
                raise AssertionError(result.stdout)
            cls.projects.append(project)
        cls.bills = [(project.build_dir / "pump.cdx.json").read_bytes() for project in cls.projects]
        cls.project = cls.projects[0]

    def bill(self, project: Project) -> dict:
        return json.loads((project.build_dir / "pump.cdx.json").read_text(encoding="utf-8"))

    def test_is_cyclonedx(self) -> None:
        try:
            schema = CycloneDx(WORK)
        except Skipped as reason:
            self.skipTest(str(reason))
        bill = self.bill(self.project)
        self.assertEqual(schema.problems(bill), [])
        bill["metadata"]["component"]["hashes"][0]["content"] = "00"
        self.assertEqual(len(schema.problems(bill)), 1)

    def test_has_the_hashes(self) -> None:
        bill = self.bill(self.project)
        image = bill["metadata"]["component"]
        self.assertEqual((image["type"], image["name"], image["hashes"]),
                         ("firmware", "pump", sha256sum(self.project.build_dir / "pump.bin")))
        files = {part["name"]: part["hashes"] for part in bill["components"] if part["type"] == "file"}
        self.assertEqual(files, {name: sha256sum(self.project.folder / name) for name in ("pump.eds", "pump.options.json")})

    def test_has_the_versions(self) -> None:
        bill = self.bill(self.project)
        edsc = output(EDSC, "--version").split()[1]
        compiler = output(COMPILER, "-dumpfullversion").strip()
        package = output("dpkg-query", "-W", "-f", "${Version}", "libnewlib-arm-none-eabi").split("-")[0]
        newlib = ".".join(package.split(".")[:3])  # Debian 13 adds the date
        libraries = {part["name"]: part["version"] for part in bill["components"] if part["type"] == "library"}
        self.assertEqual(libraries, {"edsc": edsc, "newlib": newlib, "libgcc": compiler})
        tools = {tool["name"]: (tool["version"], tool["description"]) for tool in bill["metadata"]["tools"]["components"]}
        self.assertEqual(tools, {"edsc": (edsc, "generates the dictionary"),
                                 COMPILER: (compiler, output(COMPILER, "--version").splitlines()[0])})

    def test_is_the_same_in_another_folder(self) -> None:
        self.assertEqual(*self.bills)

    def test_has_the_hash_of_an_eds_that_changed_in_a_comment(self) -> None:
        project = self.projects[1]
        eds = project.folder / "pump.eds"
        eds.write_text(eds.read_text() + "\n; a comment\n")
        self.assertEqual(project.build("pump").returncode, 0)
        files = {part["name"]: part["hashes"] for part in self.bill(project)["components"] if part["type"] == "file"}
        self.assertEqual(files["pump.eds"], sha256sum(eds))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
