#!/usr/bin/env python3
"""edsc in other people's builds: installed, as a subdirectory, fetched, and in a cross build; and what a rebuild does.

    package_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

BUILD_DIR is a build of edsc, from which it is installed.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
BUILD_DIR = Path(sys.argv[2]).resolve()
TOOLCHAIN = SOURCE_DIR / "cmake/toolchains/arm-none-eabi.cmake"
SHEET = SOURCE_DIR / "eds/rk5c.eds"
ARM = "arm-none-eabi-g++"

# With the flags of edsc's own build, a compiler cache that is there has edsc's objects at hand.
LIKE_EDSC_ITSELF = ["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_EXTENSIONS=OFF", "-DEDSC_UNITY_BUILD=ON",
                    *(["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else [])]

FROM_PACKAGE = "find_package(edsc REQUIRED)"
FROM_SUBDIRECTORY = f'add_subdirectory("{SOURCE_DIR}" edsc)'
FROM_FETCH_CONTENT = """include(FetchContent)
FetchContent_Declare(edsc GIT_REPOSITORY https://example.org/edsc.git)
FetchContent_MakeAvailable(edsc)"""

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
{edsc}
edsc_add_dictionary(sensor EDS sensor.eds)
if(CMAKE_CROSSCOMPILING)
  add_library(consumer OBJECT main.cpp other.cpp)
else()
  add_executable(consumer main.cpp other.cpp)
endif()
target_link_libraries(consumer PRIVATE sensor)
"""

MAIN = """#include <canopen/object_store.hpp>
#include <sensor/device.hpp>

int main() {
  canopen::ObjectStore<sensor::Device> store;
  store.reset_communication(canopen::NodeId{5});
  return store.get<sensor::od::cob_id_emcy>() == 0x85 ? 0 : 1;
}
"""
OTHER = """#include <sensor/pdo.hpp>

unsigned bits_of_the_first_tpdo() { return sensor::Tpdo1::bits; }
"""


def run(*command: object, folder: Path | None = None) -> str:
    """Output of a command that must succeed."""
    result = subprocess.run([str(word) for word in command], cwd=folder, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, errors="replace", timeout=600)
    if result.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: exit code {result.returncode}\n{result.stdout[-3000:]}")
    return result.stdout


class Consumer:
    """A tiny project that uses edsc."""

    def __init__(self, folder: Path, edsc: str, *settings: str) -> None:
        self.source = folder / "consumer"
        self.build_dir = self.source / "build"
        self.source.mkdir()
        (self.source / "CMakeLists.txt").write_text(PROJECT.format(edsc=edsc))
        (self.source / "main.cpp").write_text(MAIN)
        (self.source / "other.cpp").write_text(OTHER)
        shutil.copy(SHEET, self.sheet)
        self.options.write_text("{}")
        run("cmake", "-S", self.source, "-B", self.build_dir, "-G", "Ninja", *LIKE_EDSC_ITSELF, *settings)

    @property
    def sheet(self) -> Path:
        return self.source / "sensor.eds"

    @property
    def options(self) -> Path:
        return self.source / "sensor.options.json"

    @property
    def dictionary(self) -> Path:
        return self.build_dir / "edsc/sensor/sensor/dictionary.hpp"

    def build(self) -> str:
        return run("cmake", "--build", self.build_dir)

    def run(self) -> None:
        run(self.build_dir / "consumer")


class PackageTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc package ")).resolve()  # with a blank on purpose
        self.addCleanup(shutil.rmtree, self.folder)

    def install(self) -> str:
        prefix = self.folder / "prefix"
        run("cmake", "--install", BUILD_DIR, "--prefix", prefix)
        return f"-DCMAKE_PREFIX_PATH={prefix}"


class Uses(PackageTest):
    def check(self, edsc: str, *settings: str) -> None:
        consumer = Consumer(self.folder, edsc, *settings)
        consumer.build()
        consumer.run()
        self.assertIn("no work to do", consumer.build())

    def test_an_installed_package(self) -> None:
        self.check(FROM_PACKAGE, self.install())

    def test_an_installed_edsc_brings_completions_and_its_manual_page(self) -> None:
        self.install()
        for path in ("bash-completion/completions/edsc", "zsh/site-functions/_edsc", "man/man1/edsc.1"):
            self.assertIn("edsc", (self.folder / "prefix/share" / path).read_text())

    def test_a_subdirectory(self) -> None:
        self.check(FROM_SUBDIRECTORY)

    def test_fetch_content(self) -> None:
        self.check(FROM_FETCH_CONTENT, f"-DFETCHCONTENT_SOURCE_DIR_EDSC={SOURCE_DIR}")

    def test_an_installed_package_of_another_version_is_refused(self) -> None:
        with self.assertRaisesRegex(AssertionError, "99.0"):
            Consumer(self.folder, "find_package(edsc 99.0 REQUIRED)", self.install())


class Arguments(PackageTest):
    def test_static_mapping_keeps_the_mapping_in_flash(self) -> None:
        sheet = f'"{SOURCE_DIR}/eds/cpc-tc1.eds"'
        calls = f"edsc_add_dictionary(fixed EDS {sheet} STATIC_MAPPING)\nedsc_add_dictionary(mapped EDS {sheet})"
        consumer = Consumer(self.folder, f"{FROM_PACKAGE}\n{calls}", self.install())
        run("cmake", "--build", consumer.build_dir, "--target", "fixed_headers", "mapped_headers")
        word = "{} | offsetof(RpdoMappingParameter, mapping_entry_1)"
        for name, place in (("fixed", "rom"), ("mapped", "ram")):
            text = (consumer.build_dir / f"edsc/{name}/{name}/dictionary.hpp").read_text()
            self.assertIn(word.format(place), text)


class Mistakes(PackageTest):
    def test_are_named_when_cmake_runs(self) -> None:
        for call, words in (("edsc_add_dictionary(other)", "EDS is missing"),
                            ("edsc_add_dictionary(other EDS none.eds)", "does not exist"),
                            ("edsc_add_dictionary(other EDS sensor.eds NAME x)", "unknown arguments: NAME")):
            with self.subTest(call=call), self.assertRaisesRegex(AssertionError, words):
                try:
                    Consumer(self.folder, f"{FROM_PACKAGE}\n{call}", self.install())
                finally:
                    shutil.rmtree(self.folder / "consumer")

    def test_in_the_data_sheet_fail_the_build_and_leave_the_headers(self) -> None:
        consumer = Consumer(self.folder, FROM_PACKAGE, self.install())
        consumer.build()
        before = consumer.dictionary.read_bytes()
        text = consumer.sheet.read_text()
        consumer.sheet.write_text(text.replace("DefaultValue=0x60200120", "DefaultValue=0x60210120"))
        with self.assertRaisesRegex(AssertionError, r"sensor\.eds:\d+:14: error: .*\[pdo-object\]"):
            consumer.build()
        self.assertEqual(consumer.dictionary.read_bytes(), before)


class Rebuilds(PackageTest):
    def setUp(self) -> None:
        super().setUp()
        self.consumer = Consumer(self.folder, FROM_PACKAGE, self.install())
        self.consumer.build()
        time.sleep(0.01)

    def expect(self, generated: bool, compiled: bool) -> None:
        log = self.consumer.build()
        self.assertEqual("Generating sensor" in log, generated, log)
        self.assertEqual("Building CXX object" in log, compiled, log)
        self.assertIn("no work to do", self.consumer.build())

    def test_nothing_when_nothing_has_changed(self) -> None:
        self.assertIn("no work to do", self.consumer.build())

    def test_what_a_changed_data_sheet_changes(self) -> None:
        text = self.consumer.sheet.read_text()
        self.consumer.sheet.write_text(text.replace("ParameterName=Cyclic timer", "ParameterName=Cycle time"))
        self.expect(generated=True, compiled=True)
        self.assertIn("struct cycle_time ", self.consumer.dictionary.read_text())

    def test_no_object_file_when_the_headers_stay_the_same(self) -> None:
        os.utime(self.consumer.sheet)
        self.expect(generated=True, compiled=False)
        self.consumer.sheet.write_text(self.consumer.sheet.read_text() + "\n; a comment at the end\n")
        self.expect(generated=True, compiled=False)

    def test_only_what_includes_the_header_that_has_changed(self) -> None:
        text = self.consumer.sheet.read_text()
        self.consumer.sheet.write_text(text.replace("ProductName=RK5C", "ProductName=RK5D"))
        log = self.consumer.build()
        self.assertIn("main.cpp", log)
        self.assertNotIn("other.cpp", log, "pdo.hpp and dictionary.hpp are the same")

    def test_what_a_changed_options_file_changes(self) -> None:
        self.consumer.options.write_text('{ "names": { "6200h": "period" } }')
        self.expect(generated=True, compiled=True)
        self.assertIn("struct period ", self.consumer.dictionary.read_text())

    def test_headers_that_have_been_deleted(self) -> None:
        shutil.rmtree(self.consumer.dictionary.parent)
        self.consumer.build()
        self.assertTrue(self.consumer.dictionary.exists())


@unittest.skipUnless(shutil.which(ARM), f"SKIPPED: {ARM} is not installed")
class CrossBuild(PackageTest):
    def check(self, edsc: str, *settings: str) -> None:
        consumer = Consumer(self.folder, edsc, f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}", *settings)
        consumer.build()
        objects = list(consumer.build_dir.glob("CMakeFiles/consumer.dir/*.o*"))
        self.assertEqual(len(objects), 2)
        for path in objects:
            self.assertEqual(path.read_bytes()[18], 40, f"{path.name} is no Arm object")  # e_machine of the ELF header

    def test_with_an_edsc_that_is_there(self) -> None:
        self.check(FROM_SUBDIRECTORY, f"-DEDSC_EXECUTABLE={BUILD_DIR / 'generator/edsc'}")

    def test_with_an_edsc_that_is_built_for_the_host(self) -> None:
        self.check(FROM_SUBDIRECTORY)

    def test_with_an_installed_package(self) -> None:
        self.check(FROM_PACKAGE, self.install().replace("CMAKE_PREFIX_PATH=", "edsc_ROOT="))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
