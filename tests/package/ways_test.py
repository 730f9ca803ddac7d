#!/usr/bin/env python3
"""Each way to use edsc in a project, for the host and for a Cortex-M, as docs/install.md describes it.

    ways_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

The commands and the CMake lines are those of the document. The commands run in a copy of the sources without build folders and
git.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

from consumer import (BUILD_DIR, EM_ARM, ENVIRONMENT, FROM_PACKAGE, SOURCE_DIR, TOOLCHAIN, WITHOUT_ARM, Project, copy_sources,
                      run, use_compiler_cache)

BLOCK = re.compile(r"<!-- run by: tests/package/ways_test.py -->\n```(\w+)\n(.*?)```", re.DOTALL)
EDSC = BUILD_DIR / "generator/edsc"
WITHOUT_COMPILING = "Without compiling edsc in each project"
WITHOUT_DPKG = "" if shutil.which("dpkg-shlibdeps") and shutil.which("file") else "SKIPPED: dpkg-dev or file is not installed"

# A toolchain file that searches everything but programs in its own root.
STRICT_TOOLCHAIN = """include("{toolchain}")
set(CMAKE_FIND_ROOT_PATH "${{CMAKE_CURRENT_LIST_DIR}}/root")
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
"""

# Settings of a project, and properties that edsc must not change.
SETTINGS = """set(CMAKE_CXX_STANDARD 17)
set(CMAKE_UNITY_BUILD ON)
set(BUILD_SHARED_LIBS ON)
enable_testing()
"""
UNCHANGED = """
foreach(property COMPILE_OPTIONS COMPILE_DEFINITIONS INCLUDE_DIRECTORIES LINK_OPTIONS LINK_LIBRARIES TESTS)
  get_directory_property(value ${property})
  message(STATUS "behind edsc: ${property}=${value}")
endforeach()
message(STATUS "behind edsc: CMAKE_CXX_STANDARD=${CMAKE_CXX_STANDARD}")
message(STATUS "behind edsc: CMAKE_MODULE_PATH=${CMAKE_MODULE_PATH}")
message(STATUS "behind edsc: CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}")
"""


def blocks(section: str, language: str) -> list[str]:
    """The blocks of a section of the document that are for this test."""
    text = (SOURCE_DIR / "docs/install.md").read_text(encoding="utf-8").split(f"\n## {section}\n")[1].split("\n## ")[0]
    return [block for found, block in BLOCK.findall(text) if found == language]


class Projects(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = Path(tempfile.mkdtemp(prefix="edsc-ways-")).resolve()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        use_compiler_cache(cls.folder)
        cls.sources = cls.folder / "sources"
        copy_sources(cls.sources)
        cls.prefix = cls.folder / "a prefix"  # here and below: with a blank on purpose
        ENVIRONMENT["PREFIX"] = str(cls.prefix)

    def document(self, section: str, number: int) -> str:
        return run("bash", "-euc", blocks(section, "sh")[number], folder=self.sources)

    @staticmethod
    def in_sources(path: str) -> Path:
        return SOURCE_DIR / path.replace("doc/edsc/", "").replace("edsc/schema", "docs/schema")

    def built(self) -> None:
        """Builds and installs edsc once, by the first commands of the document."""
        if not self.prefix.exists():
            self.document("Installed", 0)

    def nothing_to_do(self, build_dir: Path) -> None:
        self.assertIn("no work to do", run("ninja", "-C", build_dir, "-d", "explain"))

    def check_host(self, project: Project, *settings: object) -> str:
        log = project.configure(*settings)
        project.build()
        run(project.build_dir / "valve_test")
        self.nothing_to_do(project.build_dir)
        return log

    def check_image(self, build_dir: Path) -> None:
        for suffix in ("elf", "hex", "bin", "map", "report.txt", "cdx.json"):
            self.assertGreater((build_dir / f"valve_firmware.{suffix}").stat().st_size, 0, suffix)
        self.assertEqual((build_dir / "valve_firmware.elf").read_bytes()[18], EM_ARM)
        self.assertIn("of which the objects of the EDS take", (build_dir / "valve_firmware.report.txt").read_text())
        self.nothing_to_do(build_dir)

    def check_cross(self, project: Project, *settings: object) -> None:
        project.configure(*settings)
        project.build()
        self.check_image(project.build_dir)

    def archive(self) -> Path:
        archive = self.folder / "edsc.tar.gz"
        if not archive.exists():
            with tarfile.open(archive, "w:gz", compresslevel=1) as tar:
                tar.add(self.sources, "edsc-0.9.0", filter=lambda entry: None if "/build" in entry.name else entry)
        return archive


class Ways(Projects):
    # ---- installed ----

    def test_installed(self) -> None:
        self.built()
        self.document("Installed", 1)
        self.nothing_to_do(self.sources / "build/valve")
        for path in ("bash-completion/completions/edsc", "zsh/site-functions/_edsc", "man/man1/edsc.1"):
            self.assertIn("edsc", (self.prefix / "share" / path).read_text())
        for path in ("doc/edsc/README.md", "doc/edsc/docs/install.md", "doc/edsc/examples/project/valve.eds",
                     "doc/edsc/eds/rk5c.eds", "edsc/schema/options.schema.json"):
            self.assertEqual((self.prefix / "share" / path).read_bytes(), self.in_sources(path).read_bytes(), path)

    @unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
    def test_installed_for_a_cortex_m(self) -> None:
        self.built()
        self.document("Installed", 2)
        self.check_image(self.sources / "build/valve-m3")

    def test_an_installed_program_of_another_version_is_refused(self) -> None:
        self.built()
        other = self.folder / "other edsc"
        other.write_text("#!/bin/sh\necho edsc 0.0.9\n")
        other.chmod(0o755)
        with self.assertRaisesRegex(AssertionError, r"is\s+not\s+edsc\s+0\.9\.0,\s+but:\s+edsc\s+0\.0\.9"):
            Project(self.folder / "refused").configure(f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DEDSC_EXECUTABLE={other}")

    # ---- Debian packages ----

    @unittest.skipIf(WITHOUT_DPKG, WITHOUT_DPKG)
    def test_debian_packages(self) -> None:
        self.built()
        self.document("Debian packages", 0)
        architecture = run("dpkg", "--print-architecture").strip()
        program, development = (self.sources / f"build/release/{name}" for name in (
            f"edsc_0.9.0_{architecture}.deb", "libedsc-dev_0.9.0_all.deb"))
        for package, fields in ((program, {"Package": "edsc", "Architecture": architecture}),
                                (development, {"Package": "libedsc-dev", "Architecture": "all"})):
            for field, value in fields.items():
                self.assertEqual(run("dpkg-deb", "-f", package, field).strip(), value)
            self.assertRegex(run("dpkg-deb", "-f", package, "Maintainer"), r"maintainers <.+@.+>")
            self.assertRegex(run("dpkg-deb", "-f", package, "Description"), r"Compiler for CANopen.*\n .+")
        for library in ("libc6", "libstdc", "libfmt", "libcpp-httplib", "libpugixml", "libnettle", "zlib1g"):
            self.assertIn(library, run("dpkg-deb", "-f", program, "Depends"))
        self.assertEqual(run("dpkg-deb", "-f", development, "Depends").strip(), "edsc (= 0.9.0)")

        files = [{line.split(maxsplit=5)[5] for line in run("dpkg-deb", "-c", package).splitlines() if line[0] != "d"}
                 for package in (program, development)]
        self.assertEqual(files[0] & files[1], set())
        self.assertLessEqual({"./usr/bin/edsc", "./usr/share/man/man1/edsc.1.gz", "./usr/share/doc/edsc/copyright",
                              "./usr/share/bash-completion/completions/edsc", "./usr/share/doc/edsc/docs/install.md",
                              "./usr/share/edsc/schema/options.schema.json"}, files[0])
        root = self.folder / "root"
        for package in (program, development):
            run("dpkg-deb", "-x", package, root)
        prefix = f"-DCMAKE_PREFIX_PATH={root / 'usr'}"
        self.check_host(Project(self.folder / "debian"), prefix)
        if not WITHOUT_ARM:
            self.check_cross(Project(self.folder / "debian arm"), prefix,
                             f"-DCMAKE_TOOLCHAIN_FILE={root / 'usr/share/cmake/edsc' / TOOLCHAIN}")

    # ---- sources ----

    @unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
    def test_fetch_content_for_a_cortex_m(self) -> None:
        project = Project(self.folder / "fetched-arm", blocks("FetchContent", "cmake")[0], build_dir=self.sources / "m3-b")
        self.check_cross(project, f"-DCMAKE_TOOLCHAIN_FILE={self.sources / 'cmake' / TOOLCHAIN}", "-DEDSC_ARCHIVE=",
                         f"-DFETCHCONTENT_SOURCE_DIR_EDSC={self.sources}")

    def test_fetch_content_without_an_installed_edsc(self) -> None:
        archive = self.archive()
        project = Project(self.folder / "not found", blocks(WITHOUT_COMPILING, "cmake")[0])
        self.check_host(project, f"-DEDSC_EXECUTABLE={EDSC}", f"-DEDSC_ARCHIVE={archive}", "-DCMAKE_DISABLE_FIND_PACKAGE_edsc=ON")
        self.assertTrue((project.build_dir / "_deps/edsc-src/runtime").is_dir())

    def test_a_file_with_errors_that_cannot_be_changed(self) -> None:
        """KEEP_GOING: the object in error becomes a DOMAIN, which the node omits; without it nothing is generated."""
        project = Project(self.folder / "keep going", f'add_subdirectory("{self.sources}" edsc)')
        text = project.sheet.read_text().replace("SupportedObjects=1\n1=0x2000", "SupportedObjects=2\n1=0x2000\n2=0x2001")
        project.sheet.write_text(text + "[2001]\nParameterName=Odd\nObjectType=0x7\nDataType=0x7F00\nAccessType=ro\n")
        project.configure(f"-DEDSC_EXECUTABLE={EDSC}")
        with self.assertRaisesRegex(AssertionError, r"\[data-type\](.|\n)*--keep-going \(KEEP_GOING in CMake\)"):
            project.build()
        lists = project.lists.read_text()
        project.lists.write_text(lists.replace("edsc_add_dictionary(valve EDS valve.eds)",
                                               "edsc_add_dictionary(valve EDS valve.eds KEEP_GOING)"))
        main = project.source / "main.cpp"
        parts = "canopen::Composition<valve::Device, canopen::without<valve::od::odd>>"
        main.write_text(main.read_text().replace("make_node<valve::Device>", f"make_node<{parts}>"))
        self.assertIn("[data-type]", project.build())
        run(project.build_dir / "valve_test")

    def test_sources_with_a_program_that_is_there(self) -> None:
        """edsc is not compiled, and its folder has a blank in its path."""
        sources = self.folder / "the sources"
        copy_sources(sources)
        conformance = "\nenable_testing()\nedsc_add_conformance_test(valve_conforms valve)\n"
        project = Project(self.folder / "a program", f'add_subdirectory("{sources}" edsc)', conformance)
        self.check_host(project, f"-DEDSC_EXECUTABLE={EDSC}")
        self.assertIn("100% tests passed", run("ctest", "--test-dir", project.build_dir, "-L", "conformance"))
        self.assertNotIn("edsc_compiler", (project.build_dir / "build.ninja").read_text())
        if not WITHOUT_ARM:
            project = Project(self.folder / "program arm", f'add_subdirectory("{sources}" edsc)')
            self.check_cross(project, f"-DEDSC_EXECUTABLE={EDSC}",
                             f"-DCMAKE_TOOLCHAIN_FILE={sources / 'cmake' / TOOLCHAIN}")
            self.assertNotIn("edsc_host", (project.build_dir / "build.ninja").read_text())

    # ---- boards ----

    @unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
    def test_a_board_of_the_projects_own(self) -> None:
        self.built()
        project = Project(self.folder / "own board")
        package = self.prefix / "share/cmake/edsc"
        shutil.copytree(package / "boards/microbit", project.source / "my_board")
        memory = project.source / "my_board/memory.ld"
        memory.write_text(memory.read_text().replace("ORIGIN = 0x00000000", "ORIGIN = 0x00008000"))
        project.lists.write_text(project.lists.read_text().replace("BOARD mps2-an385", "BOARD my_board"))
        self.check_cross(project, f"-DCMAKE_PREFIX_PATH={self.prefix}", f"-DCMAKE_TOOLCHAIN_FILE={package / TOOLCHAIN}")
        symbols = run("arm-none-eabi-nm", "--numeric-sort", project.build_dir / "valve_firmware.elf")
        self.assertRegex(symbols, r"(?m)^00008[0-9a-f]{3} T reset$")


class MoreWays(Projects):
    """As Ways, with other folders and paths; before a release."""

    @unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
    def test_installed_beside_headers_of_the_host(self) -> None:
        """The host has headers with the names of all those of newlib and libstdc++. A toolchain file searches only its root."""
        self.built()
        prefix = self.folder / "like usr"
        shutil.copytree(self.prefix, prefix)
        for name in ("cstdint", "array", "span", "stdint.h", "string.h"):
            (prefix / "include" / name).write_text("#error a header of the host\n")
        strict = self.folder / "strict/toolchain.cmake"
        strict.parent.mkdir()
        package = prefix / "share/cmake/edsc"
        strict.write_text(STRICT_TOOLCHAIN.format(toolchain=package / TOOLCHAIN))
        self.check_cross(Project(self.folder / "strict/project"), f"-DCMAKE_TOOLCHAIN_FILE={strict}", f"-Dedsc_DIR={package}")

    def test_installed_and_found_by_the_path(self) -> None:
        self.built()
        project = Project(self.folder / "by path")
        path = ENVIRONMENT["PATH"]
        ENVIRONMENT["PATH"] = f"{self.prefix / 'bin'}{os.pathsep}{path}"
        try:
            self.check_host(project)
        finally:
            ENVIRONMENT["PATH"] = path
        self.assertIn(f"{self.prefix}/bin/edsc", (project.build_dir / "CMakeCache.txt").read_text())

    @unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
    def test_a_subdirectory_for_a_cortex_m(self) -> None:
        """edsc is built for the host, independent of the compilers in the environment."""
        line = blocks("A subdirectory", "cmake")[0].replace("(edsc)", f'("{self.sources}" edsc)')
        toolchain = self.sources / "cmake" / TOOLCHAIN
        project = Project(self.folder / "subdirectory-arm", line, build_dir=self.sources / "m3-a")  # as deep as build/test
        variables = {"CXX": "arm-none-eabi-g++", "CXXFLAGS": "-mcpu=cortex-m3", "CMAKE_TOOLCHAIN_FILE": str(toolchain)}
        ENVIRONMENT.update(variables)
        try:
            self.check_cross(project)
        finally:
            for name in variables:
                del ENVIRONMENT[name]

    def test_fetch_content_of_an_installed_edsc(self) -> None:
        """The sources are not read."""
        self.built()
        project = Project(self.folder / "found", blocks(WITHOUT_COMPILING, "cmake")[0])
        self.check_host(project, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DEDSC_ARCHIVE=/does/not/exist.tar.gz")
        self.assertIn(f"edsc_DIR:PATH={self.prefix}/", (project.build_dir / "CMakeCache.txt").read_text())

    def test_sources_in_a_folder_with_a_blank(self) -> None:
        """Tests the commands of the build other than compilers."""
        sources = self.folder / "more sources"
        copy_sources(sources)
        run("cmake", "-S", sources, "-B", sources / "build", "-G", "Ninja", "-DEDSC_BUILD_TESTS=OFF",
            "-DEDSC_BUILD_EXAMPLES=OFF")
        run("cmake", "--build", sources / "build", "--target", "generator/built_in_templates.cpp")
        self.assertIn("dictionary.hpp", (sources / "build/generator/built_in_templates.cpp").read_text())


class CompiledInAProject(Projects):
    """edsc is compiled with the flags of the project: the longest tests."""

    def test_a_subdirectory(self) -> None:
        """The subdirectory does not change the project that includes it."""
        # The folders have the same names as with FetchContent, so that a compiler cache can use objects of one for the other.
        line = blocks("A subdirectory", "cmake")[0].replace("(edsc)", "(edsc-src ../edsc-build)")
        project = Project(self.folder / "subdirectory/project", SETTINGS + line + UNCHANGED)
        copy_sources(project.source / "edsc-src")
        log = self.check_host(project, "-DCMAKE_BUILD_TYPE=")
        behind = dict(re.findall(r"behind edsc: (\w+)=(.*)", log))
        launcher = ENVIRONMENT.get("CMAKE_CXX_COMPILER_LAUNCHER", "")
        self.assertEqual(behind, {
            "COMPILE_OPTIONS": "", "COMPILE_DEFINITIONS": "", "INCLUDE_DIRECTORIES": "", "LINK_OPTIONS": "",
            "LINK_LIBRARIES": "", "TESTS": "",
            "CMAKE_CXX_STANDARD": "17", "CMAKE_MODULE_PATH": "", "CMAKE_CXX_COMPILER_LAUNCHER": launcher})
        self.assertIn("Total Tests: 0", run("ctest", "--test-dir", project.build_dir, "-N"))
        run("cmake", "--install", project.build_dir, "--prefix", self.folder / "subdirectory/prefix")
        self.assertFalse((self.folder / "subdirectory/prefix").exists(), "edsc is installed with the project")

    def test_fetch_content(self) -> None:
        """FetchContent with an archive."""
        archive = self.archive()
        project = Project(self.folder / "fetched/project", blocks("FetchContent", "cmake")[0])
        self.check_host(project, f"-DEDSC_ARCHIVE={archive}", f"-DFETCHCONTENT_BASE_DIR={project.source}",
                        "-DCMAKE_BUILD_TYPE=")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
