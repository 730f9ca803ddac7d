#!/usr/bin/env python3
"""The CMake functions: their arguments, and errors in them and in the EDS.

    package_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import json
import re
import shutil
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

from consumer import ENVIRONMENT, FROM_PACKAGE, SOURCE_DIR, PackageTest, Project, run, use_compiler_cache


class Arguments(PackageTest):
    def test_static_mapping_keeps_the_mapping_in_flash(self) -> None:
        sheet = f'"{SOURCE_DIR}/eds/cpc-tc1.eds"'
        calls = f"\nedsc_add_dictionary(fixed EDS {sheet} STATIC_MAPPING)\nedsc_add_dictionary(mapped EDS {sheet})\n"
        project = Project(self.folder / "project", more=calls)
        project.configure(f"-DCMAKE_PREFIX_PATH={self.install()}")
        project.build("fixed_headers", "mapped_headers")
        word = "{} | offsetof(RpdoMappingParameter, mapping_entry_1)"
        for name, place in (("fixed", "rom"), ("mapped", "ram")):
            text = (project.build_dir / f"edsc/{name}/{name}/dictionary.hpp").read_text()
            self.assertIn(word.format(place), text)


class Conformance(PackageTest):
    def test_is_a_test_of_the_project(self) -> None:
        """The device runs its application, at the node-ID of its dictionary or DCF."""
        calls = """
enable_testing()
edsc_add_conformance_test(valve_conforms valve APPLICATION valve_application.hpp shop::Valve ARGUMENTS --only "1.*")
edsc_add_dictionary(fixed EDS valve.eds NODE_ID 0x0C)
edsc_add_conformance_test(fixed_conforms fixed LEVEL read DEVIATIONS deviations.json)
edsc_add_dictionary(axis EDS axis.dcf)
edsc_add_conformance_test(axis_conforms axis LEVEL read)
edsc_add_conformance_test(other_conforms axis LEVEL read NODE_ID 8)
"""
        project = Project(self.folder / "project", more=calls)
        (project.source / "deviations.json").touch()
        (project.source / "axis.dcf").write_text(project.sheet.read_text() + "\n[DeviceComissioning]\nNodeID=0x7\n")
        (project.source / "valve_application.hpp").write_text(APPLICATION)
        prefix = self.install()
        project.configure(f"-DCMAKE_PREFIX_PATH={prefix}")
        tests = json.loads(run("ctest", "--test-dir", project.build_dir, "--show-only=json-v1"))["tests"]
        commands = {test["name"]: test["command"][1:] for test in tests}
        sheet, build = project.sheet, project.build_dir
        self.assertEqual(commands, {
            "valve_conforms": ["conform", f"simulated:{build}/valve_conforms@5", "5", f"{sheet}", "--level", "all", "--store",
                               "--application", "--outputs", "--only", "1.*"],
            "fixed_conforms": ["conform", f"simulated:{build}/fixed_conforms@12", "12", f"{sheet}", "--level", "read",
                               "--deviations", f"{project.source}/deviations.json"],
            "axis_conforms": ["conform", f"simulated:{build}/axis_conforms@7", "7", f"{project.source}/axis.dcf",
                              "--level", "read"],
            "other_conforms": ["conform", f"simulated:{build}/other_conforms@8", "8", f"{project.source}/axis.dcf",
                               "--level", "read"]})
        project.build("valve_conforms")
        edsc = prefix / "bin/edsc"
        self.assertIn(" = 17 ", run(edsc, "read", f"simulated:{build}/valve_conforms@5", 5, "opening", "--eds", sheet))
        project.configure()
        self.assertIn("no work to do", project.build("valve_conforms"))
        self.assertIn("100% tests passed", run("ctest", "--test-dir", project.build_dir, "-R", "valve_conforms"))


APPLICATION = """#include <canopen/node.hpp>
#include <valve/device.hpp>

namespace shop {
struct Valve {
  void start(auto& node) { static_cast<void>(node.template set<valve::od::opening>(17)); }
};
}  // namespace shop
"""


class Schemas(PackageTest):
    def test_are_installed(self) -> None:
        installed = self.install() / "share/edsc/schema"
        for path in sorted((SOURCE_DIR / "docs/schema").iterdir()):
            self.assertEqual((installed / path.name).read_bytes(), path.read_bytes())


class CompilerCache(PackageTest):
    @unittest.skipUnless(shutil.which("ccache"), "SKIPPED: ccache is not installed")
    def test_dependencies_of_a_cached_object_are_those_of_this_copy_of_the_project(self) -> None:
        """The second copy uses objects of the cache after the first copy was deleted."""
        prefix = self.install()
        base = Path(tempfile.mkdtemp(prefix="edsc-cache-")).resolve()
        self.addCleanup(shutil.rmtree, base)
        for copy in (base / "first", base / "second"):
            with patch.dict(ENVIRONMENT, CCACHE_DIR=str(base / "cache")):
                use_compiler_cache(copy)
                project = Project(copy / "project", "set(CMAKE_UNITY_BUILD ON)\n" + FROM_PACKAGE)
                project.configure(f"-DCMAKE_PREFIX_PATH={prefix}")
                project.build()
                self.assertIn("no work to do", run("ninja", "-C", project.build_dir, "-d", "explain"))
                hits = re.findall(r"^(?:direct|preprocessed)_cache_hit\t(\d+)", run("ccache", "--print-stats"), re.MULTILINE)
            shutil.rmtree(copy)
        self.assertGreater(sum(map(int, hits)), 0)


class Mistakes(PackageTest):
    def test_are_named_when_cmake_runs(self) -> None:
        prefix = self.install()
        for number, (call, words) in enumerate((
                ("edsc_add_dictionary(other)", "EDS is missing"),
                ("edsc_add_dictionary(other EDS none.eds)", "does not exist"),
                ("edsc_add_dictionary(other EDS valve.eds NAME x)", "unknown arguments: NAME"),
                ("edsc_add_firmware(other EDS valve.eds SOURCES main.cpp)", "BOARD is missing"),
                ("edsc_add_firmware(other EDS valve.eds BOARD b SOURCES main.cpp)", "build is for the host"),
                ("edsc_add_conformance_test(test none)", "there is no target none"),
                ("edsc_add_conformance_test(test valve_test)", "is not a library"),
                ("edsc_add_conformance_test(test valve EDS valve.eds)", "unknown arguments: EDS"),
                ("edsc_add_conformance_test(test valve NODE_ID 128)", "128 is not a node-ID"),
                ("edsc_add_conformance_test(test valve APPLICATION main.cpp)", "takes a header and a type"),
                ("edsc_add_conformance_test(test valve APPLICATION none.hpp Valve)", "none.hpp does not exist"),
                ("edsc_add_conformance_test(test valve DEVIATIONS none.json)", "none.json does not exist"))):
            with self.subTest(call=call), self.assertRaisesRegex(AssertionError, words):
                Project(self.folder / f"project {number}", more=f"\n{call}\n").configure(f"-DCMAKE_PREFIX_PATH={prefix}")

    def test_in_the_data_sheet_fail_the_build_and_leave_the_headers(self) -> None:
        project = Project(self.folder / "project")
        project.configure(f"-DCMAKE_PREFIX_PATH={self.install()}")
        project.build()
        dictionary = project.build_dir / "edsc/valve/valve/dictionary.hpp"
        before = dictionary.read_bytes()
        text = project.sheet.read_text()
        project.sheet.write_text(text.replace("HighLimit=100\nDefaultValue=0", "HighLimit=100\nDefaultValue=500"))
        with self.assertRaisesRegex(AssertionError, r"valve\.eds:\d+:\d+: error: .*\[.*\]"):
            project.build()
        self.assertEqual(dictionary.read_bytes(), before)

    def test_an_installed_package_of_another_version_is_refused(self) -> None:
        with self.assertRaisesRegex(AssertionError, "99.0"):
            Project(self.folder / "project", FROM_PACKAGE.replace("edsc", "edsc 99.0")).configure(
                f"-DCMAKE_PREFIX_PATH={self.install()}")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
