#!/usr/bin/env python3
"""THIRD-PARTY-NOTICES and edsc.cdx.json name the libraries of the program: those whose headers its sources include and those that
it loads, with the versions of the Debian packages.

    third_party_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

npm installs the schemas of CycloneDX in BUILD_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE_DIR, BUILD_DIR = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from cyclonedx_schema import CycloneDx  # noqa: E402
from npm_packages import Skipped  # noqa: E402

THIRD_PARTY = BUILD_DIR / "third_party"
HEADERS = {  # Debian packages, and the names in the table
    "libcli11-dev": "CLI11", "libcpp-httplib-dev": "cpp-httplib", "libfmt-dev": "fmt", "libkainjow-mustache-dev": "Mustache",
    "libpugixml-dev": "pugixml", "nettle-dev": "Nettle", "nlohmann-json3-dev": "JSON for Modern C++", "zlib1g-dev": "zlib"}
# The compiler, the C library and the kernel; what the headers of the shared cpp-httplib and of Nettle include.
OF_THE_SYSTEM = re.compile(r"libc6-dev|linux-libc-dev|libstdc\+\+-\d+-dev|libgcc-\d+-dev|libssl-dev|libbrotli-dev|libgmp-dev")
SHARED = {"libfmt": "fmt", "libpugixml": "pugixml", "libz": "zlib", "libnettle": "Nettle", "libcpp-httplib": "cpp-httplib"}


def output(*command: object) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, timeout=600).stdout


# The version that the files of a package of Debian state, if it is not that of the package.
STATED = {("libfmt-dev", "10.1.1"): "10.1.0"}


class ThirdParty(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.bill = json.loads((THIRD_PARTY / "edsc.cdx.json").read_text(encoding="utf-8"))
        cls.notices = (THIRD_PARTY / "THIRD-PARTY-NOTICES").read_text(encoding="utf-8")
        cls.components = {component["name"]: component for component in cls.bill["components"]}

    def test_the_bill_of_materials_is_cyclonedx(self) -> None:
        try:
            schema = CycloneDx(BUILD_DIR / "npm/cyclonedx")
        except Skipped as reason:
            self.skipTest(str(reason))
        self.assertEqual(schema.problems(self.bill), [])
        wrong = json.loads(json.dumps(self.bill))
        wrong["components"][0]["licenses"] = [{"license": {"id": "Mit"}}]
        del wrong["components"][1]["type"]
        self.assertEqual(len(schema.problems(wrong)), 2)

    def test_has_the_libraries_whose_headers_are_included(self) -> None:
        headers: set[str] = set()
        used = False
        for line in output("ninja", "-C", BUILD_DIR, "-t", "deps").splitlines():
            if line and not line.startswith(" "):
                used = re.match(r"(generator|bus|cli)/CMakeFiles/", line) is not None
            elif used and line.startswith("    /usr/include/"):
                headers.add(line.strip())
        self.assertGreater(len(headers), 100)
        packages = {line.split(":")[0] for line in output("dpkg", "-S", *sorted(headers)).splitlines()}
        self.assertEqual({name for name in packages if not OF_THE_SYSTEM.fullmatch(name)}, set(HEADERS))
        self.assertEqual(set(self.components), {*HEADERS.values(), "uPlot"})

    def test_has_the_libraries_that_the_program_loads(self) -> None:
        needed = re.findall(r"\(NEEDED\).*\[(lib[a-z+-]+)", output("readelf", "-d", BUILD_DIR / "generator/edsc"))
        loaded = {SHARED[name] for name in needed if name in SHARED}
        self.assertEqual(loaded, set(SHARED.values()))
        inside = {name: component["properties"][0]["value"] for name, component in self.components.items()}
        self.assertEqual({name for name, value in inside.items() if value != "yes"}, loaded)

    def test_has_the_versions_of_the_packages(self) -> None:
        for package, name in HEADERS.items():
            version = output("dpkg-query", "-W", "-f", "${Version}", package)
            version = version.rpartition("+really")[2]
            upstream = re.sub(r"^\d+:|[+.](ds|dfsg).*|-[^-]*$", "", version)
            upstream = STATED.get((package, upstream), upstream)
            self.assertEqual(self.components[name]["version"], upstream)
            self.assertIn(f"\n{name} {upstream}\n    license: ", self.notices)

    def test_has_the_copyright_notices(self) -> None:
        for package in HEADERS:
            self.assertIn(Path(f"/usr/share/doc/{package}/copyright").read_text(encoding="utf-8"), self.notices)
        self.assertIn("Copyright (c) 2022 Leon Sorokin", self.notices)
        self.assertIn(Path("/usr/share/common-licenses/LGPL-3").read_text(encoding="utf-8"), self.notices)

    def test_has_no_place_and_no_time(self) -> None:
        for text in (self.notices, json.dumps(self.bill)):
            self.assertNotIn(str(SOURCE_DIR), text)
        self.assertNotIn("timestamp", self.bill["metadata"])
        self.assertNotIn("serialNumber", self.bill)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
