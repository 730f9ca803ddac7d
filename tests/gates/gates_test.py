#!/usr/bin/env python3
"""Each gate fails for a fault planted in a copy of the sources, and its message names the place.

    gates_test.py SOURCE_DIR PYTHON_WITH_JSONSCHEMA [unittest arguments]
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
PYTHON_WITH_JSONSCHEMA = sys.argv[2]
GATES = SOURCE_DIR / "tests/gates"
LAYOUT = SOURCE_DIR / "tests/layout"
HEADER = "runtime/include/canopen/base/planted.hpp"
AUTHOR = ("-c", "user.name=x", "-c", "user.email=x@example.org", "-c", "commit.gpgsign=false")


def git(folder: Path, *arguments: str) -> str:
    return subprocess.run(["git", *AUTHOR, *arguments], cwd=folder, capture_output=True, text=True, check=True).stdout


class Copy(unittest.TestCase):
    """A repository with the tracked files of this one; its origin/main is the same commit."""
    folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory(prefix="edsc-gates-")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name).resolve()
        names = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"], cwd=SOURCE_DIR,
                               capture_output=True, check=True).stdout.split(b"\0")
        for name in map(os.fsdecode, filter(None, names)):
            if (SOURCE_DIR / name).is_file():
                copy = cls.folder / name
                copy.parent.mkdir(parents=True, exist_ok=True)
                os.symlink(os.readlink(SOURCE_DIR / name), copy) if (SOURCE_DIR / name).is_symlink() else \
                    copy.write_bytes((SOURCE_DIR / name).read_bytes())
        (cls.folder / HEADER).write_text("#pragma once\n#include <map>\ninline std::map<int, int> planted;\n")
        git(cls.folder, "init", "-q", "-b", "main")
        git(cls.folder, "add", "-A")
        git(cls.folder, "commit", "-q", "-m", "Copy")
        git(cls.folder, "update-ref", "refs/remotes/origin/main", "HEAD")

    def tearDown(self) -> None:
        git(self.folder, "checkout", "-q", ".")
        git(self.folder, "clean", "-q", "-f", "-d", "-e", "build")

    def plant(self, name: str, text: str) -> None:
        """Appends the text to a file, which need not exist."""
        with (self.folder / name).open("a", encoding="utf-8") as file:
            file.write(text)

    def run_gate(self, script: Path, *arguments: object, python: str = sys.executable) -> subprocess.CompletedProcess[str]:
        return subprocess.run([python, script, self.folder, *arguments], capture_output=True, text=True,
                              env=os.environ | {"LC_ALL": "C.UTF-8"})

    def expect_failure(self, result: subprocess.CompletedProcess[str], *messages: str) -> None:
        output = result.stdout + result.stderr
        self.assertNotIn(result.returncode, (0, 77), output)
        for message in messages:
            self.assertIn(message, output)


class Scripts(Copy):
    def test_another_format_is_listed_and_fixed(self) -> None:
        name = "generator/text/planted.hpp"
        self.plant(name, "#pragma once\nint  planted ;\n")
        self.expect_failure(self.run_gate(GATES / "format.py"), f"{name}:2", "format.py . --fix")
        self.assertEqual(self.run_gate(GATES / "format.py", "--fix", name).returncode, 0)
        self.assertEqual((self.folder / name).read_text(), "#pragma once\nint planted;\n")
        self.assertEqual(self.run_gate(GATES / "format.py", name).returncode, 0)

    def test_an_ignored_file_may_have_another_format(self) -> None:
        self.plant("generated/planted.hpp", "int  planted ;\n")
        result = self.run_gate(GATES / "format.py", "generated/planted.hpp")
        self.assertEqual((result.returncode, result.stdout.strip()), (0, "0 files have the format of .clang-format"))

    def schemas(self) -> subprocess.CompletedProcess[str]:
        return self.run_gate(GATES / "schemas.py", python=PYTHON_WITH_JSONSCHEMA)

    def test_a_wrong_options_file_does_not_fit(self) -> None:
        self.plant("eds/planted.options.json", '{"settable": 1}\n')
        self.expect_failure(self.schemas(), "eds/planted.options.json: $.settable: 1 is not of type 'array'")

    def test_a_file_fits_the_schema_that_it_names(self) -> None:
        self.plant("tests/planted.json", '{"$schema": "urn:edsc:schema:deviations", "deviations": [{"case": "3.7"}]}\n')
        self.plant("tests/path.json", '{"$schema": "../docs/schema/options.schema.json", "none": 1}\n')
        self.plant("tests/unknown.json", '{"$schema": "urn:edsc:schema:planted"}\n')
        self.plant("tests/no.json", "{\n")
        self.expect_failure(self.schemas(), "tests/planted.json: $.deviations[0]: 'reason' is a required property",
                            "tests/path.json: $: Additional properties are not allowed",
                            "tests/unknown.json: unknown schema \"planted\"", "tests/no.json: Expecting")

    def test_a_schema_is_one_and_has_its_name(self) -> None:
        self.plant("docs/schema/planted.schema.json", '{"$id": "urn:edsc:schema:other"}\n')
        self.plant("docs/schema/wrong.schema.json", '{"$id": "urn:edsc:schema:wrong", "type": 1,'
                   ' "$schema": "https://json-schema.org/draft/2020-12/schema"}\n')
        self.expect_failure(self.schemas(), 'planted.schema.json: expected "$id": "urn:edsc:schema:planted"',
                            "wrong.schema.json: $.type: 1 is not valid under any of the given schemas")

    def test_an_include_of_a_higher_module_is_reported(self) -> None:
        self.plant("generator/text/utf8.cpp", '#include "device/device.hpp"\n')
        self.expect_failure(self.run_gate(LAYOUT / "includes_test.py"), "generator/text/utf8.cpp includes device/device.hpp")

    def test_a_walkthrough_of_a_function_that_does_not_exist_is_reported(self) -> None:
        document = self.folder / "docs/developers/architecture.md"
        document.write_text(document.read_text(encoding="utf-8").replace("`parse_ini`", "`planted_ini`"), encoding="utf-8")
        self.expect_failure(self.run_gate(LAYOUT / "walkthrough_test.py"), "ini.cpp does not contain planted_ini")

    def test_two_types_of_one_name_in_different_programs_are_reported(self) -> None:
        definition = "namespace planted {{\nstruct Planted {{\n  {} value;\n}};\n}}\n"
        self.plant("generator/text/utf8.hpp", definition.format("int"))
        self.plant("tests/support/bench.hpp", definition.format("double"))
        self.plant("generated/cpd/device.hpp", "namespace planted {\nnamespace {\nstruct Planted {};\n}\n}\n")
        result = self.run_gate(GATES / "type_names.py")
        self.expect_failure(result, "planted::Planted is defined in generator/text/utf8.hpp:", " and tests/support/bench.hpp:")
        self.assertNotIn("generated/cpd", result.stdout)

    @unittest.skipUnless(shutil.which("reuse"), "SKIPPED: reuse is not installed")
    def test_a_license_without_its_text_is_reported(self) -> None:
        self.assertEqual(self.run_gate(GATES / "licenses.py").returncode, 0)
        self.plant("generator/text/planted.hpp", "// SPDX-License-" + "Identifier: Zlib\n")
        self.expect_failure(self.run_gate(GATES / "licenses.py"), "Missing licenses: Zlib", "generator/text/planted.hpp")

    def test_a_phrase_to_avoid_is_reported(self) -> None:
        self.plant("README.md", "The bus eats " + "frames.\n")
        self.expect_failure(self.run_gate(LAYOUT / "words_test.py"), 'README.md:', 'write "consumes"')


class Sources(Copy):
    """The build of the copy is configured once; each test builds what it changes."""

    @classmethod
    def setUpClass(cls) -> None:
        super().setUpClass()
        subprocess.run(["cmake", "--preset", "test"], cwd=cls.folder, capture_output=True, check=True)

    def sources(self) -> subprocess.CompletedProcess[str]:
        return self.run_gate(GATES / "sources.py", self.folder / "build/test")

    def test_nothing_is_compiled_if_nothing_differs(self) -> None:
        result = self.sources()
        self.assertEqual((result.returncode, result.stdout), (0, "no source to compile\n"))

    def test_a_header_that_does_not_compile_alone_is_reported(self) -> None:
        (self.folder / HEADER).write_text("#pragma once\ninline std::map<int, int> planted;\n")
        self.expect_failure(self.sources(), f"Compiling {HEADER} alone", "planted.hpp:2:", "‘map’ in namespace ‘std’")

    def test_warnings_and_findings_of_clang_tidy_are_errors(self) -> None:
        self.plant("generator/text/suggestion.cpp",
                   "namespace edsc {\nstatic int planted(long wide) { return wide; }\n"
                   "std::string moved_twice(std::string text);\n"
                   "std::string moved_twice(std::string text) { std::string a = std::move(text); return a + text; }\n}\n")
        self.expect_failure(self.sources(), "-Werror=conversion", "[bugprone-use-after-move")

    def test_two_types_of_one_name_are_reported(self) -> None:
        """In two sources that are compiled as parts of two files."""
        for name, member in (("generator/text/suggestion.cpp", "int*"), ("generator/eds/number.cpp", "double")):
            self.plant(name, f"namespace edsc {{\nstruct Planted {{\n  {member} value = {{}};\n}};\n"
                             f"Planted planted({member} value);\nPlanted planted({member} value) {{ return {{value}}; }}\n}}\n")
        subprocess.run(["cmake", "--preset", "odr"], cwd=self.folder, capture_output=True, check=True)
        result = subprocess.run(["cmake", "--build", "--preset", "odr"], cwd=self.folder, capture_output=True, text=True)
        self.expect_failure(result, "violates the C++ One Definition Rule", "struct Planted")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
