#!/usr/bin/env python3
"""`edsc check` as a CI job uses it: severities and exit codes, silenced rules, and SARIF.

    check_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
BASE = (SOURCE_DIR / "tests/rules/base.eds").read_text(encoding="utf-8")
SCHEMA = json.loads((SOURCE_DIR / "tests/fixtures/sarif-2.1.0-subset.schema.json").read_text(encoding="utf-8"))

FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2

# What a line of the base sheet becomes, and which rule says so.
NOTE = ("FileName=example.eds", "FileName=other.eds", "file-name")
WARNING = ("SupportedObjects=11", "SupportedObjects=12", "object-list-count")
ERROR = ("LowLimit=0\nHighLimit=3000\nDefaultValue=100", "DefaultValue=fast", "number-format")


class CheckTest(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def sheet(self, *changes: tuple[str, str, str], name: str = "example.eds") -> str:
        text = BASE
        for old, new, _ in changes:
            self.assertIn(old, text)
            text = text.replace(old, new)
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def run_edsc(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)

    def check(self, *arguments: str) -> tuple[int, dict]:
        result = self.run_edsc("check", "--format", "json", *arguments)
        return result.returncode, json.loads(result.stdout)

    def sarif(self, *arguments: str) -> dict:
        document = json.loads(self.run_edsc("check", "--format", "sarif", *arguments).stdout)
        jsonschema.validate(document, SCHEMA)
        return document


class Severities(CheckTest):
    def test_only_errors_fail(self) -> None:
        for changes, code in (((), FINE), ((NOTE,), FINE), ((NOTE, WARNING), FINE), ((ERROR,), INPUT_HAS_ERRORS)):
            returncode, findings = self.check(self.sheet(*changes))
            self.assertEqual(returncode, code)
            self.assertEqual([d["rule"] for d in findings["diagnostics"]], [rule for _, _, rule in reversed(changes)])

    def test_warnings_fail_when_strict_and_notes_never_do(self) -> None:
        for changes, code in (((), FINE), ((NOTE,), FINE), ((NOTE, WARNING), INPUT_HAS_ERRORS)):
            self.assertEqual(self.check(self.sheet(*changes), "--strict")[0], code)

    def test_each_severity_is_counted(self) -> None:
        _, findings = self.check(self.sheet(NOTE, WARNING, ERROR))
        self.assertEqual([findings[key] for key in ("errors", "warnings", "notes")], [1, 1, 1])
        text = self.run_edsc("check", self.sheet(NOTE)).stdout
        self.assertTrue(text.endswith("example.eds: 0 errors, 0 warnings, 1 note\n"), text)

    def test_generate_shows_no_notes(self) -> None:
        result = self.run_edsc("generate", self.sheet(NOTE), "-o", "out")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))

    def test_the_file_as_a_whole_is_its_first_line(self) -> None:
        _, findings = self.check(self.sheet(("[DeviceInfo]", "[Comments2]", "")))
        place = next(d for d in findings["diagnostics"] if d["rule"] == "no-device-info")
        self.assertEqual((place["line"], place["column"]), (1, 1))

    def test_the_reference_devices_have_no_findings(self) -> None:
        sheets = sorted(str(path) for path in (SOURCE_DIR / "eds").glob("*.eds"))
        self.assertEqual(len(sheets), 8)
        returncode, findings = self.check("--strict", *sheets)
        self.assertEqual((returncode, findings["diagnostics"]), (FINE, []))


class Silence(CheckTest):
    def test_by_the_command_line(self) -> None:
        sheet = self.sheet(NOTE, WARNING, ERROR)
        returncode, findings = self.check(sheet, "--silence", "number-format", "--silence", "file-name")
        self.assertEqual(returncode, FINE)
        self.assertEqual([d["rule"] for d in findings["diagnostics"]], ["object-list-count"])

    def test_of_one_rule_before_a_file(self) -> None:
        returncode, findings = self.check("--silence", "file-name", self.sheet(ERROR))
        self.assertEqual((returncode, len(findings["diagnostics"])), (INPUT_HAS_ERRORS, 1))

    def test_by_the_options_file(self) -> None:
        (self.folder / "example.options.json").write_text('{"silence": ["object-list-count"]}', encoding="utf-8")
        returncode, findings = self.check(self.sheet(WARNING), "--strict")
        self.assertEqual((returncode, findings["diagnostics"]), (FINE, []))

    def test_of_a_rule_that_is_none(self) -> None:
        sheet = self.sheet()
        self.assertEqual(self.run_edsc("check", sheet, "--silence", "no-such-rule").returncode, WRONG_USAGE)
        (self.folder / "example.options.json").write_text('{"silence": ["no-such-rule"]}', encoding="utf-8")
        returncode, findings = self.check(sheet)
        self.assertEqual((returncode, [d["rule"] for d in findings["diagnostics"]]), (INPUT_HAS_ERRORS, ["options"]))


class Sarif(CheckTest):
    def test_of_a_sheet_without_findings(self) -> None:
        run = self.sarif(self.sheet())["runs"][0]
        self.assertEqual(run["results"], [])
        self.assertEqual(run["tool"]["driver"]["name"], "edsc")
        version = self.run_edsc("--version").stdout.split()[-1]
        self.assertEqual(run["tool"]["driver"]["version"], version)

    def test_has_all_rules_with_their_severities(self) -> None:
        rules = json.loads(self.run_edsc("check", "--list-rules", "--format", "json").stdout)
        driver = self.sarif(self.sheet())["runs"][0]["tool"]["driver"]
        self.assertEqual([(rule["id"], rule["severity"]) for rule in rules],
                         [(rule["id"], rule["defaultConfiguration"]["level"]) for rule in driver["rules"]])
        self.assertGreaterEqual(len(rules), 60)

    def test_says_the_same_as_json(self) -> None:
        twice = [(f"ParameterName={name}", "ParameterName=Größe", "") for name in ("Pressure", "Serial text")]
        sheets = [self.sheet(NOTE, WARNING, ERROR), self.sheet(*twice, name="two.eds")]
        run = self.sarif(*sheets)["runs"][0]
        _, findings = self.check(*sheets)
        self.assertEqual(run["columnKind"], "unicodeCodePoints")
        self.assertEqual([self.flat(run, result) for result in run["results"]],
                         [(d["rule"], d["severity"], d["message"], d["file"], d["line"], d["column"],
                           d["column"] + d["length"], [(n["line"], n["message"]) for n in d["notes"]])
                          for d in findings["diagnostics"]])
        self.assertTrue(any(result.get("relatedLocations") for result in run["results"]))

    def flat(self, run: dict, result: dict) -> tuple:
        self.assertEqual(run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"], result["ruleId"])
        place = result["locations"][0]["physicalLocation"]
        region = place["region"]
        notes = [(note["physicalLocation"]["region"]["startLine"], note["message"]["text"])
                 for note in result.get("relatedLocations", [])]
        return (result["ruleId"], result["level"], result["message"]["text"], place["artifactLocation"]["uri"],
                region["startLine"], region["startColumn"], region["endColumn"], notes)

    def test_writes_a_path_as_a_uri(self) -> None:
        (self.folder / "my sheets").mkdir()
        run = self.sarif(self.sheet(NOTE, name="my sheets/größe.eds"))["runs"][0]
        self.assertEqual(self.uri(run), "my%20sheets/gr%C3%B6%C3%9Fe.eds")
        run = self.sarif(str(self.folder / self.sheet(NOTE)))["runs"][0]
        self.assertTrue(self.uri(run).startswith("file:///"), self.uri(run))

    @staticmethod
    def uri(run: dict) -> str:
        return run["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]

    def test_counts_what_is_not_listed(self) -> None:
        lines = "".join(f"a line that is nothing {i}\n" for i in range(60))
        run = self.sarif(self.sheet(("[Comments]\n", f"[Comments]\n{lines}", "")))["runs"][0]
        notification = run["invocations"][0]["toolExecutionNotifications"][0]
        self.assertEqual(notification["associatedRule"]["id"], "stray-line")
        self.assertEqual(notification["message"]["text"], "10 more findings of stray-line")

    def test_of_a_file_that_cannot_be_read(self) -> None:
        result = self.run_edsc("check", "--format", "sarif", "missing.eds")
        document = json.loads(result.stdout)
        jsonschema.validate(document, SCHEMA)
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertEqual(document["runs"][0]["results"][0]["ruleId"], "unreadable-file")

    def test_the_schema_refuses_what_sarif_refuses(self) -> None:
        good = self.sarif(self.sheet(NOTE))
        for path, value in ((("version",), "2.0.0"), (("runs", 0, "results", 0, "level"), "fatal"),
                            (("runs", 0, "results", 0, "message"), {}), (("runs", 0, "tool", "driver"), {}),
                            (("runs", 0, "results", 0, "locations", 0, "physicalLocation", "region", "startLine"), 0)):
            bad = json.loads(json.dumps(good))
            at = bad
            for step in path[:-1]:
                at = at[step]
            at[path[-1]] = value
            with self.assertRaises(jsonschema.ValidationError, msg=path):
                jsonschema.validate(bad, SCHEMA)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
