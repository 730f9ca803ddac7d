#!/usr/bin/env python3
"""What a project rebuilds after a change, and that two builds of the same sources have the same bytes.

    rebuilds_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import os
import shutil
import sys
import time
import unittest
from pathlib import Path

from consumer import ENVIRONMENT, SOURCE_DIR, TOOLCHAIN, WITHOUT_ARM, PackageTest, Project

SHEET = SOURCE_DIR / "eds/rk5c.eds"
SENSOR = """
edsc_add_dictionary(sensor EDS sensor.eds)
add_executable(sensor_test sensor.cpp other.cpp)
target_link_libraries(sensor_test PRIVATE sensor)
"""
MAIN = """#include <canopen/od/object_store.hpp>
#include <sensor/device.hpp>

int main() {
  canopen::ObjectStore<sensor::Device> store;
  store.reset_communication(canopen::NodeId{5});
  return store.get<sensor::od::cob_id_emcy>().can_id() == 0x85 ? 0 : 1;
}
"""
LINE = """
edsc_add_network(line_network line.json)
add_executable(line_test line.cpp)
target_link_libraries(line_test PRIVATE line_network)
"""
LINE_FILE = """{
  "bit_rate": 500,
  "nodes": {"control": {"node_id": 127, "master": true}, "sensor": {"node_id": 5, "eds": "sensor.eds", "heartbeat_ms": 100}},
  "signals": [
    {"from": "sensor", "object": "6020h:01", "to": "control", "every_ms": 100},
    {"from": "sensor", "object": "6030h:01", "to": "control", "every_ms": 100}
  ]
}
"""
LINE_MAIN = """#include <canopen_plant/plant.hpp>
#include <line.hpp>

struct Bus {
  bool send(const canopen::Frame&) { return true; }
};

int main() {
  Bus bus;
  canopen::Plant<line::Network, Bus> plant{bus};
  return plant.sensor.speed_value_1() ? 1 : 0;
}
"""
OTHER = """#include <sensor/pdo.hpp>

unsigned bits_of_the_first_tpdo() { return sensor::Tpdo1::bits; }
"""


class Rebuilds(PackageTest):
    def setUp(self) -> None:
        super().setUp()
        self.project = Project(self.folder / "project", more=SENSOR)
        self.sheet = self.project.source / "sensor.eds"
        self.options = self.project.source / "sensor.options.json"
        self.dictionary = self.project.build_dir / "edsc/sensor/sensor/dictionary.hpp"
        (self.project.source / "sensor.cpp").write_text(MAIN)
        (self.project.source / "other.cpp").write_text(OTHER)
        shutil.copy(SHEET, self.sheet)
        self.options.write_text("{}")
        self.project.configure(f"-DCMAKE_PREFIX_PATH={self.install()}")
        self.build()
        time.sleep(0.01)

    def build(self) -> str:
        return self.project.build("sensor_test")

    def expect(self, generated: bool, compiled: bool) -> None:
        log = self.build()
        self.assertEqual("Generating sensor" in log, generated, log)
        self.assertEqual("Building CXX object" in log, compiled, log)
        self.assertIn("no work to do", self.build())

    def test_nothing_when_nothing_has_changed(self) -> None:
        self.assertIn("no work to do", self.build())

    def test_what_a_changed_data_sheet_changes(self) -> None:
        text = self.sheet.read_text()
        self.sheet.write_text(text.replace("ParameterName=Cyclic timer", "ParameterName=Cycle time"))
        self.expect(generated=True, compiled=True)
        self.assertIn("struct cycle_time ", self.dictionary.read_text())

    def test_no_object_file_when_the_headers_stay_the_same(self) -> None:
        os.utime(self.sheet)
        self.expect(generated=True, compiled=False)
        self.sheet.write_text(self.sheet.read_text() + "\n; a comment at the end\n")
        self.expect(generated=True, compiled=False)

    def test_only_what_includes_the_header_that_has_changed(self) -> None:
        text = self.sheet.read_text()
        self.sheet.write_text(text.replace("ProductName=RK5C", "ProductName=RK5D"))
        log = self.build()
        self.assertIn("sensor.cpp", log)
        self.assertNotIn("other.cpp", log, "pdo.hpp and dictionary.hpp are the same")

    def test_what_a_changed_overlay_or_base_changes(self) -> None:
        overlay = self.project.source / "sensor.overlay"
        rename = "[Overlay]\nVersion=1\nBase=sensor.eds\n[6200]\nParameterName=Cyclic timer => {}\n"
        overlay.write_text(rename.format("Period"))
        self.project.lists.write_text(self.project.lists.read_text().replace("EDS sensor.eds", "EDS sensor.overlay"))
        self.expect(generated=True, compiled=True)
        self.assertIn("struct period ", self.dictionary.read_text())
        overlay.write_text(rename.format("Interval"))
        self.expect(generated=True, compiled=True)
        self.assertIn("struct interval ", self.dictionary.read_text())
        self.sheet.write_text(self.sheet.read_text().replace("ProductName=RK5C", "ProductName=RK5D"))
        self.expect(generated=True, compiled=True)
        self.options.write_text('{ "names": { "6200h": "of_options" } }')
        self.expect(generated=True, compiled=True)
        self.assertIn("struct of_options ", self.dictionary.read_text())

    def test_what_a_changed_options_file_changes(self) -> None:
        self.options.write_text('{ "names": { "6200h": "period" } }')
        self.expect(generated=True, compiled=True)
        self.assertIn("struct period ", self.dictionary.read_text())

    def test_headers_that_have_been_deleted(self) -> None:
        shutil.rmtree(self.dictionary.parent)
        self.build()
        self.assertTrue(self.dictionary.exists())


class Network(PackageTest):
    """A network file of one node, and a program that includes its header."""

    def setUp(self) -> None:
        super().setUp()
        self.project = Project(self.folder / "project", more=LINE)
        self.sheet = self.project.source / "sensor.eds"
        self.network = self.project.source / "line.json"
        self.header = self.project.build_dir / "edsc/line_network/line.hpp"
        (self.project.source / "line.cpp").write_text(LINE_MAIN)
        shutil.copy(SHEET, self.sheet)
        self.network.write_text(LINE_FILE)
        self.project.configure(f"-DCMAKE_PREFIX_PATH={self.install()}")
        self.project.build("line_test")
        time.sleep(0.01)

    def test_what_is_generated_again(self) -> None:
        self.assertIn("no work to do", self.project.build("line_test"))
        os.utime(self.network)
        log = self.project.build("line_test")
        self.assertIn("Generating line_network", log)
        self.assertNotIn("Building CXX object", log)
        self.network.write_text(LINE_FILE.replace('"node_id": 5', '"node_id": 6'))
        self.assertIn("Building CXX object", self.project.build("line_test"))
        self.assertIn("node_id{ 6 }", self.header.read_text())
        self.sheet.write_text(self.sheet.read_text().replace("ParameterName=Cyclic timer", "ParameterName=Cycle time"))
        self.assertIn("Building CXX object", self.project.build("line_test"))
        self.assertIn("struct cycle_time ", (self.header.parent / "sensor/dictionary.hpp").read_text())
        self.assertIn("no work to do", self.project.build("line_test"))

    def test_the_build_fails_where_check_does(self) -> None:
        self.network.write_text(LINE_FILE.replace('"node_id": 5', '"node_id": 127'))
        with self.assertRaisesRegex(AssertionError, "(?s)line.json:.*node-ID 127"):
            self.project.build("line_test")
        self.network.write_text(LINE_FILE)
        self.project.build("line_test")


@unittest.skipIf(WITHOUT_ARM, WITHOUT_ARM)
class SameBytes(PackageTest):
    """In two folders with different names, without a common compiler cache."""

    def setUp(self) -> None:
        super().setUp()
        ENVIRONMENT.pop("CMAKE_CXX_COMPILER_LAUNCHER", None)

    def test_of_headers_and_images(self) -> None:
        for build_type, kinds in (("Release", ("elf", "hex", "bin", "report.txt")), ("Debug", ("hex", "bin"))):
            made = []
            for name in ("a", "a folder with a longer name"):
                source = self.folder / build_type / name
                prefix = source / "prefix"
                shutil.copytree(self.install(), prefix)
                project = Project(source / f"project {name}", build_dir=source / f"build {name}")
                project.configure(f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_BUILD_TYPE={build_type}",
                                  f"-DCMAKE_TOOLCHAIN_FILE={prefix / 'share/cmake/edsc' / TOOLCHAIN}")
                project.build()
                made.append(self.outputs(project.build_dir, kinds))
            self.assertEqual(len(made[0]), len(kinds) + 6)
            for path, content in made[0].items():
                self.assertEqual(made[1].get(path), content, f"{path} depends on the folder ({build_type})")

    @staticmethod
    def outputs(build_dir: Path, kinds: tuple[str, ...]) -> dict[str, bytes]:
        paths = [*(build_dir / "edsc").rglob("*.hpp"), *(build_dir / f"valve_firmware.{kind}" for kind in kinds)]
        return {str(path.relative_to(build_dir)): path.read_bytes() for path in paths}


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
