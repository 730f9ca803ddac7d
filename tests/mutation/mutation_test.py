#!/usr/bin/env python3
"""The mutation check on a small project of known mutants, and the table of equivalent ones.

    mutation_test.py SOURCE_DIR

Skipped without libclang's Python module (python3-clang-14).
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

try:
    import clang.cindex  # noqa: F401
except ImportError:
    print("skipped: no python3-clang-14")
    sys.exit(77)

import equivalents
import mutation
from project import Area, Program, Project

SAMPLE = Path(__file__).resolve().parent / "sample"
SOURCE_DIR = Path(sys.argv.pop(1)).resolve()
HEADER = "include/sample.hpp"
GREETING = 'inline std::string greeting(const std::string& name) { return "Hello, " + name; }'


def git(folder: Path, *arguments: str) -> None:
    subprocess.run(["git", "-c", "user.name=test", "-c", "user.email=test@localhost", *arguments], cwd=folder,
                   check=True, capture_output=True)


class SampleProject(unittest.TestCase):
    """One build of all mutants of the sample; the tests check its report."""

    @classmethod
    def setUpClass(cls) -> None:
        # Git passes the location of its repository to a hook; these tests have their own.
        for variable in [name for name in os.environ if name.startswith("GIT_")]:
            del os.environ[variable]
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.root = Path(cls.temporary.name).resolve() / "sample"
        shutil.copytree(SAMPLE, cls.root)
        git(cls.root, "init", "--quiet")
        git(cls.root, "commit", "--quiet", "--allow-empty", "--message", "Start")
        git(cls.root, "add", "--all")
        known = cls.root / "equivalents.tsv"
        known.write_text("file\tline\tmutated\treason\n"
                         f"{HEADER}\tint sum = 0;\tint sum = 1;\tnot true, but known\n"
                         f"{HEADER}\tfor (int i = 0; i < last; i += 1) {{\tfor (int i = 1; i < last; i += 1) {{\t"
                         "adds 0 once less\n")
        cls.project = Project(
            root=cls.root, include_folders=("include",), equivalents=known,
            areas=(Area("all", ("include/",), (Program("sample_test", ("include/",), ("{build}/sample_test",),
                                                    ("sample_test",)),), mutates_constexpr_variables=True),))
        cls.exit_code, cls.output = cls.check()
        assert cls.exit_code == 1, cls.output
        cls.report = json.loads((cls.root.parent / "mutation/report.json").read_text())

    @classmethod
    def check(cls, *arguments: str) -> tuple[int, str]:
        parsed = mutation.parse_arguments(
            ["--folder", str(cls.root.parent / "mutation"), *(arguments or ("--against", "HEAD"))])
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            code = mutation.run(cls.project, parsed)
        return code, output.getvalue()

    def mutants(self, before: str) -> dict[str, dict]:
        """Returns the mutants of a line of the sample, by the mutated line."""
        self.assertIn(before, [line.strip() for line in (SAMPLE / HEADER).read_text().splitlines()])
        return {row["after"]: row for row in self.report["mutants"] if row["before"] == before}

    def test_kills_what_a_test_notices(self) -> None:
        line = "inline bool is_adult(int age) { return age >= 18; }"
        rows = self.mutants(line)
        self.assertEqual({"inline bool is_adult(int age) { return age > 18; }",
                          "inline bool is_adult(int age) { return age < 18; }",
                          "inline bool is_adult(int age) { return age >= 17; }",
                          "inline bool is_adult(int age) { return age >= 19; }",
                          "inline bool is_adult(int age) { return {}; }"}, set(rows))
        for row in rows.values():
            self.assertEqual(("killed", "sample_test: is_adult"), (row["outcome"], row["how"]))

    def test_reports_survivors(self) -> None:
        rows = self.mutants("inline int untested_edge(int age) { return age < 18 ? 1 : 2; }")
        edge = rows["inline int untested_edge(int age) { return age <= 18 ? 1 : 2; }"]
        self.assertEqual(("survived", ["sample_test"]), (edge["outcome"], edge["programs"]))
        self.assertIn(f"{HEADER}:{edge['line']}: comparison < -> <=: survived", self.output)
        self.assertIn("  + inline int untested_edge(int age) { return age <= 18 ? 1 : 2; }", self.output)

    def test_ends_a_program_that_hangs(self) -> None:
        rows = self.mutants("for (int i = 0; i < last; i += 1) {")
        hang = rows["for (int i = 0; i < last; i += 0) {"]
        self.assertEqual(("killed", "sample_test: hangs"), (hang["outcome"], hang["how"]))

    def test_drops_what_does_not_compile(self) -> None:
        self.assertNotIn(GREETING.replace("+", "-"), self.mutants(GREETING))
        self.assertGreaterEqual(self.report["counts"]["does not compile"], 1)

    def test_mutates_a_dropped_return_value(self) -> None:
        mutant = GREETING.replace('return "Hello, " + name', "return {}")
        self.assertEqual("killed", self.mutants(GREETING)[mutant]["outcome"])

    def test_mutates_a_constexpr_table(self) -> None:
        rows = self.mutants("constexpr Row rows[] = {{1, 10}, {2, 20}};")
        self.assertEqual("killed", rows["constexpr Row rows[] = {{1, 10}, {2, 21}};"]["outcome"])
        self.assertEqual("survived", rows["constexpr Row rows[] = {{1, 11}, {2, 20}};"]["outcome"])

    def test_leaves_out_what_the_compiler_evaluates(self) -> None:
        for line in ("enum class Color : std::uint8_t { red = 1, green = 2 };", "int data[size + 1] = {};",
                     "static_assert(twice(4) == 8);"):
            self.assertEqual({}, self.mutants(line), line)
        rows = self.mutants("constexpr int twice(int number) { return number * 2; }")
        self.assertTrue(rows)
        self.assertEqual({"compile time"}, {row["outcome"] for row in rows.values()})

    def test_counts_what_no_program_reaches(self) -> None:
        rows = self.mutants("inline int never_called(int number) { return number + 1; }")
        self.assertEqual({"not reached"}, {row["outcome"] for row in rows.values()})

    def test_subtracts_and_shows_known_equivalents(self) -> None:
        rows = self.mutants("for (int i = 0; i < last; i += 1) {")
        known = rows["for (int i = 1; i < last; i += 1) {"]
        self.assertEqual(("equivalent", "adds 0 once less"), (known["outcome"], known["how"]))
        self.assertIn("known as equivalent: adds 0 once less", self.output)

    def test_a_known_equivalent_that_is_killed_counts_as_killed(self) -> None:
        self.assertEqual("killed", self.mutants("int sum = 0;")["int sum = 1;"]["outcome"])

    def test_the_score_is_that_of_the_counts(self) -> None:
        counts = self.report["counts"]
        unnoticed = counts["survived"] + counts["not reached"]
        self.assertAlmostEqual(100 * counts["killed"] / (counts["killed"] + unnoticed), self.report["score"], 2)
        self.assertEqual(1, self.exit_code)
        self.assertIn(f"{self.report['score']:.1f} % of the mutants were noticed", self.output)

    def test_a_sample_is_that_of_its_seed(self) -> None:
        code, output = self.check("--sample", "3", "--seed", "7", "--min-score", "0")
        self.assertEqual(0, code, output)
        self.assertIn("3 mutants in 1 files", output)
        first = json.loads((self.root.parent / "mutation/report.json").read_text())
        self.check("--sample", "3", "--seed", "7", "--min-score", "0")
        self.assertEqual(first, json.loads((self.root.parent / "mutation/report.json").read_text()))

    def test_without_a_change_there_is_nothing_to_do(self) -> None:
        git(self.root, "commit", "--quiet", "--all", "--message", "All")
        self.addCleanup(git, self.root, "reset", "--quiet", "--soft", "HEAD^")
        code, output = self.check("--against", "HEAD")
        self.assertEqual((0, "0 mutants in 0 files\n"), (code, output))

    def test_does_not_score_when_a_program_fails_without_a_mutant(self) -> None:
        test = self.root / "tests/sample_test.cpp"
        text = test.read_text()
        self.addCleanup(test.write_text, text)
        test.write_text(text.replace("== 6", "== 7"))
        code, output = self.check("--sample", "1", "--seed", "7")
        self.assertEqual(2, code)
        self.assertIn("sample_test fails without a mutant: sum_up_to", output)

    def test_does_not_score_when_the_copy_does_not_compile(self) -> None:
        test = self.root / "tests/sample_test.cpp"
        text = test.read_text()
        self.addCleanup(test.write_text, text)
        test.write_text(text + "int broken() { return missing; }\n")
        code, output = self.check("--sample", "1", "--seed", "7")
        self.assertEqual(2, code)
        self.assertIn("missing", output)


class Equivalents(unittest.TestCase):
    def test_each_row_has_a_reason_and_a_line_of_its_file(self) -> None:
        known = equivalents.read_equivalents(SOURCE_DIR / "tests/mutation/equivalents.tsv")
        self.assertEqual([], equivalents.stale_rows(SOURCE_DIR, known))
        self.assertEqual([], [row for row in known if not row.reason])


if __name__ == "__main__":
    unittest.main()
