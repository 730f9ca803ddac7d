#!/usr/bin/env python3
"""`edsc check` as a CI job uses it: severities and exit codes, silenced rules, and SARIF.

    check_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse
from pathlib import Path

import jsonschema

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
BASE = (SOURCE_DIR / "tests/generator/lint/base.eds").read_text(encoding="utf-8")
SCHEMA = json.loads((SOURCE_DIR / "tests/fixtures/sarif-2.1.0-subset.schema.json").read_text(encoding="utf-8"))

FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2

# A line of the base EDS, its replacement, and the rule that reports it.
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
        self.each_rule_is_known(document)
        return document

    def each_rule_is_known(self, document: dict) -> None:
        for run in document["runs"]:
            rules = {rule["id"] for rule in run["tool"]["driver"]["rules"]}
            self.assertLessEqual({result["ruleId"] for result in run["results"]}, rules)
            for invocation in run.get("invocations", []):
                named = {one["associatedRule"]["id"] for one in invocation["toolExecutionNotifications"] if "associatedRule" in one}
                self.assertLessEqual(named, rules)


class UserProfile(CheckTest):
    """A profile database in the syntax of an EDS."""
    ROWS = "[2003]\nParameterName=Speed\nObjectType=7\nDataType=7\nAccessType=ro\n"

    def check_with(self, rows: str) -> subprocess.CompletedProcess[str]:
        (self.folder / "profile.eds").write_text(rows, encoding="utf-8")
        return self.run_edsc("check", "--profile", "profile.eds", self.sheet())

    def test_gives_rows_for_objects(self) -> None:
        result = self.check_with(self.ROWS)
        self.assertRegex(result.stdout, r"2003h:00 .* is VISIBLE_STRING; .*profile.eds requires UNSIGNED32 \[profile-data-type\]")

    def test_is_for_the_devices_of_its_profile(self) -> None:
        other = "[1000]\nParameterName=Type\nObjectType=7\nDataType=7\nAccessType=const\nDefaultValue=404\n"
        self.assertNotIn("profile-", self.check_with(other + self.ROWS).stdout)

    def test_without_objects_is_an_error(self) -> None:
        result = self.check_with("[FileInfo]\n")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS, result.stdout)
        self.assertIn("the profile does not have an object from 2000h on [no-objects]", result.stdout)


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


class Merging(CheckTest):
    def test_of_process_data_that_cannot_be_mapped(self) -> None:
        """One finding for each access type, with all its places."""
        entry = "\n[{:04X}]\nParameterName=Value {}\nObjectType=0x7\nDataType=0x0006\nAccessType={}\nPDOMapping=0\n"
        words = ("rwr", "rwr", "rww", "rwr", "rww")
        text = BASE + "".join(entry.format(0x3000 + number, number, word) for number, word in enumerate(words))
        (self.folder / "example.eds").write_text(text, encoding="utf-8")
        lines = {word: [i for i, line in enumerate(text.splitlines(), 1)
                        if line == f"AccessType={word}" and i > BASE.count("\n")] for word in words}
        found = [one for one in self.check("example.eds")[1]["diagnostics"] if one["rule"] == "process-data-not-mappable"]
        places = [[one["line"], *(also["line"] for also in one["notes"])] for one in found]
        self.assertEqual(sorted(places), sorted(lines.values()))


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


class Allow(CheckTest):
    """Expected findings, with a scope and a reason, in the options file or in a comment."""

    def allowed(self, sheet: str, *arguments: str) -> list[tuple]:
        """(rule, line, kind, reason, line of the allowance) of each allowed finding."""
        _, findings = self.check(sheet, *arguments)
        self.assertEqual(len(findings["allowed_diagnostics"]), findings["allowed"])
        return [(d["rule"], d["line"], d["allowance"]["kind"], d["allowance"]["reason"], d["allowance"]["line"])
                for d in findings["allowed_diagnostics"]]

    def options(self, *rows: dict) -> None:
        text = json.dumps({"allow": rows}, indent=1)
        (self.folder / "example.options.json").write_text(text, encoding="utf-8")

    def line_of(self, text: str) -> int:
        lines = (self.folder / "example.eds").read_text(encoding="utf-8").splitlines()
        return lines.index(text) + 1

    def commented(self, before: str, comment: str, *changes: tuple[str, str, str]) -> str:
        return self.sheet(*changes, (before, f"{comment}\n{before}", ""))

    def test_of_the_line_below_a_comment(self) -> None:
        sheet = self.commented("SupportedObjects=12", "; edsc: allow object-list-count - of a tool", WARNING)
        line = self.line_of("SupportedObjects=12")
        self.assertEqual(self.allowed(sheet, "--strict"), [("object-list-count", line, "inSource", "of a tool", line - 1)])
        self.assertEqual(self.run_edsc("check", sheet, "--strict").returncode, FINE)
        elsewhere = self.commented("FileRevision=1", "; edsc: allow object-list-count - of a tool", WARNING)
        returncode, findings = self.check(elsewhere, "--strict")
        self.assertEqual((returncode, [d["rule"] for d in findings["diagnostics"]]),
                         (INPUT_HAS_ERRORS, ["allow-unused", "object-list-count"]))
        self.assertEqual(findings["diagnostics"][0]["line"], self.line_of("FileRevision=1") - 1)

    def test_of_the_section_below_a_comment_and_of_the_file(self) -> None:
        for before in ("[DeviceInfo]", "; The sheet"):
            bad = (("BaudRate_10=0", "BaudRate_10=x", ""), ("BaudRate_20=0", "BaudRate_20=y", ""))
            sheet = self.commented(before, "; edsc: allow device-info-flag - a reason\n\n; other words", *bad)
            self.assertEqual([row[0] for row in self.allowed(sheet)], ["device-info-flag"] * 2)
            self.assertEqual(self.check(sheet)[1]["diagnostics"], [])

    def test_of_an_object_or_entry_in_the_options_file(self) -> None:
        sheet = self.sheet(ERROR)
        line = self.line_of("DefaultValue=fast")
        text = (self.folder / sheet).read_text(encoding="utf-8")
        index = text[:text.index("DefaultValue=fast")].rsplit("[", 1)[1].split("]")[0]
        for scope in ({"object": f"{index}h"}, {"object": f"{index}h:00"}, {}):
            self.options({"rule": "number-format", "reason": "not ours", **scope})
            self.assertEqual([row[:4] for row in self.allowed(sheet)], [("number-format", line, "external", "not ours")])
            self.assertEqual(self.check(sheet)[0], FINE)
        self.options({"rule": "number-format", "reason": "not ours", "object": "1000h"})
        returncode, findings = self.check(sheet)
        self.assertEqual((returncode, [d["rule"] for d in findings["diagnostics"]]),
                         (INPUT_HAS_ERRORS, ["number-format", "allow-unused"]))
        self.assertTrue(findings["diagnostics"][1]["file"].endswith("example.options.json"))

    def test_of_an_error_for_check_only(self) -> None:
        sheet = self.sheet(ERROR)
        self.options({"rule": "number-format", "reason": "not ours"})
        self.assertEqual(self.check(sheet)[0], FINE)
        result = self.run_edsc("generate", sheet, "-o", "out")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertIn("[number-format]", result.stderr)

    def test_of_a_warning_for_each_command(self) -> None:
        self.options({"rule": "object-list-count", "reason": "of a tool"})
        result = self.run_edsc("generate", self.sheet(WARNING), "-o", "out")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))

    def test_is_counted_in_the_text(self) -> None:
        self.options({"rule": "object-list-count", "reason": "of a tool"}, {"rule": "file-name", "reason": "renamed"})
        self.assertEqual(self.run_edsc("check", self.sheet(WARNING, NOTE)).stdout, "example.eds: 0 errors, 0 warnings, 2 allowed\n")

    def test_of_more_findings_than_are_listed(self) -> None:
        sheet = self.commented("; The sheet", "; edsc: allow stray-line - many", ("[Comments]", "[Comments]\n" + "stray\n" * 60, ""))
        _, findings = self.check(sheet)
        self.assertEqual((len(findings["allowed_diagnostics"]), findings["allowed"], findings["warnings"]), (50, 60, 0))

    def test_of_an_xdd(self) -> None:
        xdd = """<ISO15745ProfileContainer xmlns:xsi="x"><ISO15745Profile><ProfileBody><ApplicationLayers><CANopenObjectList>
<CANopenObject index="2000" name="A" objectType="7" dataType="05" accessType="rw" defaultValue="x"/>
<CANopenObject index="2001" name="B" objectType="9" subNumber="1"><CANopenSubObject subIndex="00" name="C" objectType="7"
 dataType="05" accessType="ro" defaultValue="y"/></CANopenObject><CANopenObject index="2002" name="D" objectType="7" dataType="05"
 accessType="rw" defaultValue="z"/></CANopenObjectList></ApplicationLayers></ProfileBody></ISO15745Profile></ISO15745ProfileContainer>
"""
        (self.folder / "example.xdd").write_text(xdd, encoding="utf-8")
        for scope, lines in (({"object": "2000h"}, [2]), ({"object": "2001h"}, [4]), ({"object": "2001h:00"}, [4]),
                             ({"object": "2002h"}, [5]), ({}, [2, 4, 5])):
            self.options({"rule": "number-format", "reason": "not ours", **scope})
            self.assertEqual([row[1] for row in self.allowed("example.xdd")], lines, scope)

    def test_that_does_not_fire_is_reported(self) -> None:
        (self.folder / "example.options.json").write_text(
            '{"silence": ["object-list-count", "pdo-size"],\n "allow": [{"rule": "file-name", "reason": "renamed"}]}', encoding="utf-8")
        sheet = self.commented("[DeviceInfo]", "; edsc: allow file-date - a tool", WARNING)
        _, findings = self.check(sheet)
        self.assertEqual([(d["rule"], d["severity"], d["line"], d["message"]) for d in findings["diagnostics"]], [
            ("allow-unused", "warning", 1, 'no finding of "pdo-size" matches'),
            ("allow-unused", "warning", 2, 'no finding of "file-name" matches'),
            ("allow-unused", "warning", self.line_of("[DeviceInfo]") - 1, 'no finding of "file-date" matches')])
        self.assertEqual(self.run_edsc("generate", sheet, "-o", "out").stderr, "", "what check alone finds may be allowed")

    def test_of_an_unknown_rule(self) -> None:
        self.options({"rule": "pdo-sise", "reason": "a"})
        returncode, findings = self.check(self.sheet())
        self.assertEqual((returncode, [(d["rule"], d["message"]) for d in findings["diagnostics"]]),
                         (INPUT_HAS_ERRORS, [("options", 'allow: unknown rule "pdo-sise"; did you mean "pdo-size"?')]))
        (self.folder / "example.options.json").unlink()
        for comment, message in (
                ("; edsc: allow pdo-sise - a", 'unknown rule "pdo-sise"; did you mean "pdo-size"?'),
                ("; edsc: allow pdo-size", 'missing reason: "; edsc: allow RULE - reason"'),
                ("; edsc: alow pdo-size - a", 'a comment of edsc has the form "; edsc: allow RULE - reason"')):
            returncode, findings = self.check(self.commented("[DeviceInfo]", comment))
            self.assertEqual((returncode, [(d["rule"], d["message"]) for d in findings["diagnostics"]]),
                             (FINE, [("allow-comment", message)]))
        self.assertIn('unknown rule "pdo-sise"; did you mean "pdo-size"?',
                      self.run_edsc("check", "example.eds", "--silence", "pdo-sise").stderr)

    def test_stays_in_sarif(self) -> None:
        self.options({"rule": "number-format", "reason": "not ours"})
        sheet = self.commented("SupportedObjects=12", "; edsc: allow object-list-count - of a tool", WARNING, ERROR, NOTE)
        results = self.sarif(sheet)["runs"][0]["results"]
        found = {result["ruleId"]: [(one["kind"], one["justification"]) for one in result["suppressions"]] for result in results}
        self.assertEqual(found, {"file-name": [], "object-list-count": [("inSource", "of a tool")],
                                 "number-format": [("external", "not ours")]})
        places = [one["location"]["physicalLocation"]["artifactLocation"]["uri"]
                  for result in results for one in result["suppressions"]]
        self.assertEqual(sorted(places), ["example.eds", "example.options.json"])

    def test_stays_at_its_key_when_the_file_is_formatted(self) -> None:
        sheet = self.commented("BaudRate_10=x", "; edsc: allow device-info-flag - of a tool", ("BaudRate_10=0", "BaudRate_10=x", ""))
        self.assertEqual(self.run_edsc("format", sheet, "-o", "canonical.eds").returncode, FINE)
        self.assertEqual([row[0] for row in self.allowed("canonical.eds")], ["device-info-flag"])


class Documentation(CheckTest):
    def test_of_a_rule(self) -> None:
        result = self.run_edsc("check", "--explain", "pdo-length")
        rule = json.loads(self.run_edsc("check", "--explain", "pdo-length", "--format", "json").stdout)
        self.assertEqual(result.returncode, FINE)
        self.assertEqual(set(rule), {"schema", "id", "severity", "severities", "meaning", "source", "consequences", "url", "examples"})
        (example,) = rule.pop("examples")
        self.assertEqual(result.stdout, f"pdo-length: {rule['severity']}\n{rule['meaning']}\nSource: {rule['source']}\n"
                                        f"Documentation, with examples: {rule['url']}\n\n"
                                        f"Wrong:\n\n{example['wrong'][0]}\nRight:\n\n{example['right'][0]}")
        self.assertIn("[1A00sub1]", example["wrong"][0])
        del rule["schema"]
        self.assertIn(rule, json.loads(self.run_edsc("check", "--list-rules", "--format", "json").stdout)["rules"])

    def test_is_found_beside_the_program(self) -> None:
        """An installed program names the installed document; without documents, there is no link."""
        program, page = self.folder / "a prefix/bin/edsc", self.folder / "a prefix/share/doc/edsc/docs/rules.md"
        program.parent.mkdir(parents=True)
        shutil.copy(EDSC, program)

        def explained() -> tuple[str, str]:
            command = [program, "check", "--explain", "pdo-length"]
            texts = [subprocess.run([*command, "--format", form], capture_output=True, text=True, check=True).stdout
                     for form in ("text", "json")]
            return texts[0], json.loads(texts[1])["url"]

        text, url = explained()
        self.assertEqual(("Documentation" in text, url), (False, ""))
        page.parent.mkdir(parents=True)
        shutil.copy(SOURCE_DIR / "docs/rules.md", page)
        text, url = explained()
        self.assertIn(f"Documentation, with examples: {url}\n", text)
        target, anchor = url.removeprefix("file://").split("#")
        self.assertEqual((Path(urllib.parse.unquote(target)), anchor), (page.resolve(), "pdo-length"))

    def test_of_an_unknown_rule(self) -> None:
        result = self.run_edsc("check", "--explain", "pdo-lenght")
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertIn('unknown rule "pdo-lenght"; did you mean "pdo-length"?', result.stderr)

    def test_has_an_anchor_for_each_rule(self) -> None:
        headings = set(re.findall(r"^## (.*)$", (SOURCE_DIR / "docs/rules.md").read_text(encoding="utf-8"), re.MULTILINE))
        for rule in self.sarif(self.sheet())["runs"][0]["tool"]["driver"]["rules"]:
            page, anchor = rule["helpUri"].rsplit("/", 1)[1].split("#")
            self.assertEqual((page, anchor), ("rules.md", rule["id"]))
            self.assertIn(anchor, headings)


class Suggestions(CheckTest):
    def messages(self, *changes: tuple[str, str, str]) -> list[str]:
        return [d["message"] for d in self.check(self.sheet(*changes))[1]["diagnostics"]]

    def test_of_a_key(self) -> None:
        for key, hint in (("CreatedBye", '; did you mean "CreatedBy"?'), ("Colour", "")):
            self.assertEqual(self.messages(("CreatedBy=edsc", f"CreatedBy=edsc\n{key}=edsc", "")),
                             [f'unknown key "{key}" in section "FileInfo"; ignored{hint}'])
        self.assertTrue(any(message.endswith('in section "1000"; ignored; did you mean "AccessType"?')
                            for message in self.messages(("[1000]", "[1000]\nAccesType=ro", ""))))
        self.assertTrue(any(message.endswith('did you mean "SupportedObjects"?')
                            for message in self.messages(("[MandatoryObjects]", "[MandatoryObjects]\nSuportedObjects=3", ""))))

    def test_of_a_section(self) -> None:
        for section, hint in (("DeviceInfos", '; did you mean "DeviceInfo"?'), ("1003Vale", '; did you mean "1003Value"?'),
                              ("Colours", "")):
            self.assertEqual(self.messages(("[DeviceInfo]", f"[{section}]\n[DeviceInfo]", "")),
                             [f'unknown section "{section}"; ignored{hint}'])


class Sarif(CheckTest):
    def test_of_a_sheet_without_findings(self) -> None:
        run = self.sarif(self.sheet())["runs"][0]
        self.assertEqual(run["results"], [])
        self.assertEqual(run["tool"]["driver"]["name"], "edsc")
        version = self.run_edsc("--version").stdout.split()[1]
        self.assertEqual(run["tool"]["driver"]["version"], version)

    def test_has_all_rules_with_their_severities(self) -> None:
        rules = json.loads(self.run_edsc("check", "--list-rules", "--format", "json").stdout)["rules"]
        driver = self.sarif(self.sheet())["runs"][0]["tool"]["driver"]
        self.assertEqual([(rule["id"], rule["severity"]) for rule in rules],
                         [(rule["id"], rule["defaultConfiguration"]["level"]) for rule in driver["rules"]])
        self.assertGreaterEqual(len(rules), 60)

    def test_says_the_same_as_json(self) -> None:
        twice = [("ParameterName=Pressure", "ParameterName=Größe\nParameterName=Größe", "")]
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

    def test_states_what_is_left_out(self) -> None:
        arguments = (self.sheet(ERROR), "--keep-going", "--silence", ERROR[2])
        _, findings = self.check(*arguments)
        run = self.sarif(*arguments)["runs"][0]
        notifications = [one for invocation in run["invocations"] for one in invocation["toolExecutionNotifications"]]
        self.assertEqual([(one["message"]["text"], one["locations"][0]["physicalLocation"]["region"]["startLine"]) for one in notifications],
                         [(f"skipped: {one['what']}", one["line"]) for one in findings["left_out"]])
        self.assertTrue(notifications)

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
