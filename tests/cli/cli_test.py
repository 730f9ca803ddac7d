#!/usr/bin/env python3
"""The interface of edsc: exit codes, streams, complete output or none, and stable JSON.

    cli_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from made_fixtures import names_eds  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
FIXTURES = SOURCE_DIR / "tests/fixtures"
GOOD = FIXTURES / "every_type.eds"
CLEAN = SOURCE_DIR / "eds/rk5c.eds"
WRONG = FIXTURES / "wrong_mapping_over_64_bits.eds"
HEADERS = re.search(r"set\(EDSC_HEADERS ([^)]*)\)", (SOURCE_DIR / "cmake/EdscHeaders.cmake").read_text(encoding="utf-8"))[1].split()
MEANING_HEADERS = ["meaning.hpp", "meaning_text.hpp"]  # CiA 301 gives each device values with a meaning
ESCAPE = "\x1b["
NOBODY = 65534

FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2

# A device without findings, to which the tests add errors.
SMALL = """[FileInfo]
FileName=small.eds
[DeviceInfo]
BaudRate_125=1
[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018
[OptionalObjects]
SupportedObjects=1
1=0x1017
[1000]
ParameterName=Device type
ObjectType=7
DataType=7
AccessType=ro
DefaultValue=0
[1001]
ParameterName=Error register
ObjectType=7
DataType=5
AccessType=ro
[1017]
ParameterName=Producer heartbeat time
ObjectType=7
DataType=6
AccessType=rw
[1018]
ParameterName=Identity object
ObjectType=9
SubNumber=2
[1018sub0]
ParameterName=Highest sub-index supported
ObjectType=7
DataType=5
AccessType=ro
DefaultValue=1
[1018sub1]
ParameterName=Vendor-ID
ObjectType=7
DataType=7
AccessType=ro
"""


def snapshot(folder: Path) -> dict[str, tuple[bytes, int]]:
    """The content and time stamp of each file below a folder."""
    return {str(path.relative_to(folder)): (path.read_bytes(), path.stat().st_mtime_ns)
            for path in folder.rglob("*") if path.is_file()}


def with_mapping(kind: str, words: list[str]) -> str:
    """Returns the EDS of WRONG with another mapping of its PDO, which is a TPDO or an RPDO."""
    head, rest = WRONG.read_text().split("[1A00]\n", 1)
    tail = rest[rest.index("[ManufacturerObjects]"):]
    keys = "ObjectType=0x7\nDataType=0x{:04X}\nAccessType=rw\nDefaultValue={}\nPDOMapping=0\n\n"
    text = (f"{head}[1A00]\nParameterName=TPDO mapping parameter\nObjectType=0x9\nSubNumber={len(words) + 1}\n\n"
            f"[1A00sub0]\nParameterName=Number of mapped objects\n{keys.format(5, len(words))}")
    for sub, word in enumerate(words, 1):
        text += f"[1A00sub{sub}]\nParameterName=Mapping entry {sub}\n{keys.format(7, word)}"
    text += tail
    if kind == "TPDO":
        return text
    for of_tpdo, of_rpdo in (("TPDO", "RPDO"), ("1800", "1400"), ("1A00", "1600"), ("NODEID+0x180", "NODEID+0x200")):
        text = text.replace(of_tpdo, of_rpdo)
    return text


class CommandLine(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-cli-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.output = self.folder / "out"

    def edsc(self, *arguments: object, environment: dict[str, str] | None = None,
             **more: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", timeout=600, env={**os.environ, **(environment or {})}, **more)

    def write(self, name: str, text: str | bytes) -> Path:
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def expect(self, exit_code: int, result: subprocess.CompletedProcess[str], *words: str) -> None:
        said = result.stdout + result.stderr
        self.assertEqual(result.returncode, exit_code, said[:2000])
        for word in words:
            self.assertTrue(word in said, f"{word} not in {said[:20000]}")


class BadInput(CommandLine):
    def refuse(self, path: Path | str, exit_code: int, *words: str) -> None:
        """Every command rejects the file in the same way, and writes nothing."""
        for arguments in (("generate", path, "-o", self.output), ("check", path), ("dump", path)):
            with self.subTest(command=arguments[0]):
                self.expect(exit_code, self.edsc(*arguments), *words)
        self.assertFalse(self.output.exists())

    def test_brackets_are_part_of_a_name(self) -> None:
        for command in ("check", "format", "dump"):
            self.expect(WRONG_USAGE, self.edsc(command, "[z]"), "cannot read [z]: ")
        self.write("[a,b]", SMALL)
        self.expect(FINE, self.edsc("check", "[a,b]", "[a,b]"), "[a,b]: 0 errors")
        self.expect(FINE, self.edsc("diff", "[a,b]", "[a,b]"), "0 breaking")
        self.expect(WRONG_USAGE, self.edsc("[a]"), 'unknown command "[a]"')

    def test_a_missing_file(self) -> None:
        self.refuse("missing.eds", WRONG_USAGE, "missing.eds", "No such file", "[unreadable-file]")

    def test_a_folder(self) -> None:
        self.expect(WRONG_USAGE, self.edsc("generate", self.folder, "-o", self.output), "Is a directory", "[unreadable-file]")
        self.expect(WRONG_USAGE, self.edsc("check", self.folder), "have no EDS, DCF or XDD file")

    def test_a_file_without_permission(self) -> None:
        secret = self.write("secret.eds", SMALL)
        secret.chmod(0)
        self.folder.chmod(0o755)
        as_somebody_else = {"user": NOBODY} if os.geteuid() == 0 else {}
        try:
            result = self.edsc("check", secret, **as_somebody_else)
        except PermissionError:
            self.skipTest("SKIPPED: another user cannot run this edsc")
        self.expect(WRONG_USAGE, result, "Permission denied", "[unreadable-file]")

    def test_an_empty_file(self) -> None:
        self.refuse(self.write("empty.eds", ""), INPUT_HAS_ERRORS, "empty.eds:1:1: error:", "[empty-file]")

    def test_comments_only(self) -> None:
        self.refuse(self.write("comments.eds", "; nothing\n;\n"), INPUT_HAS_ERRORS, "[empty-file]")

    def test_binary_junk(self) -> None:
        junk = bytes((number * 167 + 13) % 256 for number in range(50_000))
        self.refuse(self.write("junk.eds", junk), INPUT_HAS_ERRORS, "[binary-file]")

    def test_xml(self) -> None:
        self.refuse(self.write("device.xdd", '<?xml version="1.0"?>\n<ISO15745ProfileContainer/>\n'), INPUT_HAS_ERRORS,
                    "[xml-profile]")

    def test_a_hundred_megabytes_of_brackets(self) -> None:
        huge = self.write("huge.eds", b"[" * 100_000_000)
        result = self.edsc("check", huge)
        self.expect(INPUT_HAS_ERRORS, result, "[unterminated-section]")
        self.assertLess(len(result.stdout), 2000)

    def test_a_million_broken_lines(self) -> None:
        result = self.edsc("check", self.write("broken.eds", "[1000]\n" + "no equals sign\n" * 1_000_000))
        self.expect(INPUT_HAS_ERRORS, result, "999950 more of this kind [stray-line]")
        self.assertLess(result.stdout.count("\n"), 400)

    def test_no_object(self) -> None:
        self.refuse(self.write("info.eds", "[FileInfo]\nFileName=info.eds\n"), INPUT_HAS_ERRORS, "[no-objects]")

    def test_an_unknown_data_type(self) -> None:
        text = SMALL + "[2000]\nParameterName=Value\nObjectType=7\nDataType=0x77\nAccessType=rw\n"
        line = text[:text.index("DataType=0x77")].count("\n") + 1
        self.refuse(self.write("type.eds", text), INPUT_HAS_ERRORS, f"type.eds:{line}:10: error:", "[data-type]")

    def test_a_data_type_by_name(self) -> None:
        for name, hint in (("float", ": REAL32 is 0x0008"), ("uint16_t", ": UNSIGNED16 is 0x0006"),
                           ("thing", "")):
            text = SMALL + f"[2000]\nParameterName=Value\nObjectType=7\nDataType={name}\nAccessType=rw\n"
            self.expect(INPUT_HAS_ERRORS, self.edsc("check", self.write("type.eds", text)),
                        f'DataType "{name}" is not a number{hint} [data-type]')
        text = SMALL + "[2000]\nParameterName=Value\nObjectType=7\nDataType=Visible_String\nAccessType=rw\n"
        self.expect(FINE, self.edsc("check", self.write("type.eds", text)),
                    "warning: DataType must be a number; that of VISIBLE_STRING is 0x0009 [data-type]")

    def test_a_section_that_stands_twice(self) -> None:
        text = SMALL + "[1000]\nParameterName=Another\nObjectType=7\nDataType=5\nAccessType=rw\n"
        line = text[:text.rindex("[1000]")].count("\n") + 1
        result = self.edsc("check", self.write("twice.eds", text))
        self.expect(FINE, result, f"twice.eds:{line}:2: warning:", "[duplicate-section]", "note:")

    def test_a_deeply_broken_file(self) -> None:
        text = SMALL.replace("DataType=7", "DataType=seven").replace("[1018sub1]", "[1018sub1")
        self.refuse(self.write("broken.eds", text.replace("=ro", "=sometimes")), INPUT_HAS_ERRORS,
                    "[data-type]", "[access-type]", "[unterminated-section]")

    def test_wrong_mappings_at_the_entry_that_is_wrong(self) -> None:
        for rule, kind, *words in (  # the last word is wrong
                ("pdo-size", "TPDO", "0x20000020", "0x20000020", "0x10010008"),  # 72 bits
                ("pdo-direction", "TPDO", "0x10010008", "0x20010020"),  # an object that is rww
                ("pdo-direction", "RPDO", "0x20010020", "0x20000020"),  # an object that is ro
                ("pdo-variable-length", "TPDO", "0x20020020"),  # a VISIBLE_STRING
                ("pdo-object", "TPDO", "0x20000020", "0x2ABC0010"),
                ("pdo-mappable", "TPDO", "0x20000020", "0x20030010"),
                ("pdo-length", "TPDO", "0x20000010")):  # 16 bits of an object of 32
            with self.subTest(rule=rule, kind=kind):
                sheet = self.write("wrong.eds", with_mapping(kind, words))
                lines = sheet.read_text().splitlines()
                number = max(at for at, line in enumerate(lines, 1) if line == f"DefaultValue={words[-1]}")
                result = self.edsc("generate", sheet, "-o", self.output)
                self.expect(INPUT_HAS_ERRORS, result, f"wrong.eds:{number}:14: error:", f"[{rule}]")
                self.assertEqual(len(re.findall(r": error: ", result.stderr)), 1, result.stderr)
                self.assertFalse(self.output.exists())


class OptionsFile(CommandLine):
    def test_beside_the_data_sheet_is_read(self) -> None:
        sheet = self.write("small.eds", SMALL)
        self.write("small.options.json", '{ "names": { "1000h": "kind" } }')
        self.expect(FINE, self.edsc("generate", sheet, "-o", self.output))
        self.assertIn("struct kind ", (self.output / "small/dictionary.hpp").read_text())

    def test_that_is_wrong_is_an_error_where_it_stands(self) -> None:
        sheet = self.write("small.eds", SMALL)
        self.write("small.options.json", '{\n  "colour": 1\n}')
        self.expect(INPUT_HAS_ERRORS, self.edsc("generate", sheet, "-o", self.output), "small.options.json:2:3: error:")
        self.assertFalse(self.output.exists())

    def test_with_an_option_that_will_be_removed_has_a_note(self) -> None:
        note = '"typed_values": false will be removed'
        sheet = self.write("small.eds", SMALL)
        self.write("small.options.json", '{"typed_values": false}')
        result = self.edsc("generate", sheet, "-o", self.output)
        self.expect(FINE, result, "small.options.json: note: " + note)
        self.assertNotIn(note, self.edsc("generate", sheet, "-o", self.output, "--target", "c").stderr)
        self.write("small.options.json", '{"typed_values": true}')
        self.assertNotIn(note, self.edsc("generate", sheet, "-o", self.output).stderr)

    def test_that_is_named_and_missing_is_wrong_usage(self) -> None:
        result = self.edsc("generate", self.write("small.eds", SMALL), "--options", "none.json", "-o", self.output)
        self.expect(WRONG_USAGE, result, "none.json")

    def test_silences_rules(self) -> None:
        sheet = self.write("small.eds", SMALL.replace("SubNumber=2", "SubNumber=9"))
        self.expect(FINE, self.edsc("check", sheet), "[sub-number]")
        self.write("small.options.json", '{ "silence": ["sub-number"] }')
        self.assertEqual(self.edsc("check", sheet).stdout, "")

    def test_reads_the_former_id_of_a_rule_with_a_note(self) -> None:
        sheet = self.write("small.eds", SMALL)
        old = "network-pdo-unheard"
        self.write("small.options.json", json.dumps({"silence": [old], "allow": [{"rule": old, "reason": "spare"}]}))
        self.assertEqual(self.edsc("check", sheet).stdout.count(
            'the rule "network-pdo-unheard" is called network-pdo-unreceived now [deprecated-option]'), 2)
        result = self.edsc("network", "check", SOURCE_DIR / "examples/networks/four_modules.json", "--silence", "network-pdo-unheard")
        self.expect(FINE, result)
        self.assertIn("edsc: note: the rule network-pdo-unheard is called network-pdo-unreceived now\n", result.stderr)
        self.assertEqual(result.stderr.count("note: the rule"), 1)


class WrongUsage(CommandLine):
    def test_is_exit_code_2_with_a_hint(self) -> None:
        for arguments in ((), ("compile",), ("generate",), ("generate", GOOD), ("check",), ("dump",),
                          ("generate", GOOD, "-o", "out", "--no-such-option"),
                          ("generate", GOOD, "--dbc", "out.dbc"),
                          ("generate", GOOD, "--dbc", "out.dbc", "--node-id", "1", "--depfile", "out.d"),
                          ("generate", GOOD, "-o", "out", "--node-id", "0"),
                          ("generate", GOOD, "-o", "out", "--node-id", "128"),
                          ("generate", GOOD, "-o", "out", "--node-id", "five"),
                          ("generate", GOOD, "-o", "out", "--name", "Not Snake"),
                          ("generate", GOOD, "-o", "out", "--name", "class"),
                          ("generate", GOOD, "-o", "out", "--name", ""),
                          ("generate", GOOD, "-o", "out", "--templates", "no-such-folder"),
                          ("check", GOOD, "--silence", "no-such-rule"), ("check", GOOD, "--format", "xml"),
                          ("check", GOOD, "--color", "sometimes")):
            with self.subTest(arguments=arguments[1:]):
                result = self.edsc(*arguments)
                self.expect(WRONG_USAGE, result)
                self.assertEqual(result.stdout, "")
                self.assertNotEqual(result.stderr, "")
        self.assertFalse(self.output.exists())

    def test_unknown_command(self) -> None:
        for arguments, message in (
                (("chek", "x"), 'edsc: unknown command "chek"; did you mean "check"?\n"edsc help" shows the usage\n'),
                (("chek", "--help"), 'edsc: unknown command "chek"; did you mean "check"?\n"edsc help" shows the usage\n'),
                (("nosuch", "--help"), 'edsc: unknown command "nosuch"\n"edsc help" shows the usage\n'),
                (("nosuch", "--version"), 'edsc: unknown command "nosuch"\n"edsc help" shows the usage\n'),
                (("lss", "socketcan:can0", "fastcan"), 'edsc: unknown command "fastcan" of edsc lss; did you mean "fastscan"?\n"edsc help lss" shows the usage\n'),
                (("lss", "socketcan:can0", "fastcan", "--help"), 'edsc: unknown command "fastcan" of edsc lss; did you mean "fastscan"?\n"edsc help lss" shows the usage\n')):
            with self.subTest(arguments=arguments):
                result = self.edsc(*arguments)
                self.assertEqual((result.returncode, result.stdout, result.stderr), (WRONG_USAGE, "", message))

    def test_help_has_examples_for_each_command(self) -> None:
        overview = self.edsc("--help").stdout
        commands = re.findall(r"^  ([a-z]+) {4,}\S", overview, re.MULTILINE)
        self.assertGreaterEqual(set(commands), {"generate", "check", "dump"})
        for command in commands:
            with self.subTest(command=command):
                result = self.edsc(command, "--help")
                self.expect(FINE, result, "Examples:", f"  edsc {command}")

    def test_version(self) -> None:
        self.assertRegex(self.edsc("--version").stdout, r"^edsc \d+\.\d+\.\d+( \(commit [0-9a-f]{12}( with changes)?\))?\n$")


class Generate(CommandLine):
    def test_writes_the_headers_of_one_device(self) -> None:
        result = self.edsc("generate", CLEAN, "-o", self.output)
        self.expect(FINE, result)
        self.assertEqual((result.stdout, result.stderr), ("", ""))
        self.assertEqual(set(snapshot(self.output)), {f"rk5c/{header}" for header in HEADERS + MEANING_HEADERS})

    def test_keeps_the_data_sheet_in_the_device(self) -> None:
        sheet = FIXTURES / "stored_eds.eds"
        for options, name in (("stored_eds", "as_text"), ("compressed_eds", "as_gzip")):
            self.expect(FINE, self.edsc("generate", sheet, "-o", self.output, "--name", name,
                                        "--options", FIXTURES / f"{options}.options.json"))
        text, packed = (bytes(int(byte, 16) for byte in re.findall(r"0x([0-9A-F]{2}),", header.read_text()))
                        for header in (self.output / "as_text/stored_eds.hpp", self.output / "as_gzip/stored_eds.hpp"))
        self.assertEqual(text, sheet.read_bytes())
        self.assertEqual(gzip.decompress(packed), sheet.read_bytes())
        uploaded = self.folder / "uploaded.gz"
        uploaded.write_bytes(packed)
        self.assertEqual(self.edsc("format", uploaded).stdout, self.edsc("format", sheet).stdout)
        uploaded.write_bytes(packed[:-1])
        self.expect(WRONG_USAGE, self.edsc("format", uploaded), "not a complete gzip file")

    def test_keeps_no_xdd_in_the_device(self) -> None:
        xdd = self.write("device.xdd", "<ISO15745ProfileContainer xmlns:xsi='x'><ISO15745Profile><ProfileBody "
                         "xsi:type='ProfileBody_CommunicationNetwork_CANopen'><ApplicationLayers><CANopenObjectList>"
                         "<CANopenObject index='1021' name='Store EDS' objectType='7' dataType='000F' accessType='ro'/>"
                         "</CANopenObjectList></ApplicationLayers></ProfileBody></ISO15745Profile>"
                         "</ISO15745ProfileContainer>\n")
        options = self.write("options.json", '{ "stored_eds": true }')
        self.expect(INPUT_HAS_ERRORS, self.edsc("generate", xdd, "-o", self.output, "--options", options),
                    "1021h holds an EDS, but this file is not an EDS")

    def test_is_deterministic(self) -> None:
        self.edsc("generate", GOOD, "-o", self.output)
        shutil.copy(GOOD, self.folder)
        self.expect(FINE, self.edsc("generate", GOOD.name, "-o", "again"))
        first, again = snapshot(self.output), snapshot(self.folder / "again")
        self.assertEqual({name: content for name, (content, _) in first.items()},
                         {name: content for name, (content, _) in again.items()})

    def test_does_not_touch_files_that_stay_the_same(self) -> None:
        self.edsc("generate", GOOD, "-o", self.output)
        before = snapshot(self.output)
        self.expect(FINE, self.edsc("generate", GOOD, "-o", self.output))
        self.assertEqual(snapshot(self.output), before)

    def test_touches_nothing_when_it_fails(self) -> None:
        sheet = self.write("small.eds", SMALL)
        depfile = self.output / "small.d"
        arguments = ("generate", sheet, "-o", self.output, "--depfile", depfile)
        self.expect(FINE, self.edsc(*arguments))
        before = snapshot(self.output)
        for wrong in ("", "[1000]\nDataType=x\n", SMALL.replace("DataType=7", "DataType=99")):
            sheet.write_text(wrong)
            self.expect(INPUT_HAS_ERRORS, self.edsc(*arguments))
            self.assertEqual(snapshot(self.output), before)

    def test_writes_all_or_nothing(self) -> None:
        (self.output / "every_type/pdo.hpp").mkdir(parents=True)
        self.expect(WRONG_USAGE, self.edsc("generate", GOOD, "-o", self.output), "pdo.hpp")
        self.assertEqual(snapshot(self.output), {})

    def test_cannot_write_below_a_file(self) -> None:
        blocked = self.write("blocked", "")
        self.expect(WRONG_USAGE, self.edsc("generate", GOOD, "-o", blocked), "blocked")

    def test_verbose_names_the_files(self) -> None:
        result = self.edsc("generate", GOOD, "-o", "out", "--verbose")
        self.assertEqual(result.stdout.split(), [f"out/every_type/{header}" for header in HEADERS + MEANING_HEADERS])

    def test_keep_going_leaves_out_what_is_wrong(self) -> None:
        result = self.edsc("generate", WRONG, "-o", self.output, "--keep-going", "--name", "wrong")
        self.expect(FINE, result, "warning: ", "[pdo-size]")
        self.assertNotIn("error: ", result.stderr)
        self.assertIn("TPDO 1, 1800h and 1A00h: skipped", (self.output / "wrong/pdo.hpp").read_text())

    def test_refusal_names_the_way_to_go_on(self) -> None:
        """Only if it helps: users can correct their options file, and a file without objects leaves nothing to generate."""
        hint = "--keep-going (KEEP_GOING in CMake)"
        self.assertTrue(self.edsc("generate", WRONG, "-o", self.output).stderr.endswith(
            "edsc: nothing was generated. For a file that you cannot change, --keep-going (KEEP_GOING in CMake) generates the "
            "rest of the device\n"))
        options = self.write("wrong.json", '{"no_such_option": 1}')
        for result in (self.edsc("generate", GOOD, "-o", self.output),
                       self.edsc("generate", WRONG, "-o", self.output, "--options", options),
                       self.edsc("generate", self.write("empty.eds", "[FileInfo]\n"), "-o", self.output)):
            self.assertNotIn(hint, result.stderr)

    def test_keep_going_refuses_what_is_not_the_fault_of_the_file(self) -> None:
        options = self.write("wrong.json", '{"no_such_option": 1}')
        self.expect(INPUT_HAS_ERRORS,
                    self.edsc("generate", WRONG, "-o", self.output, "--keep-going", "--options", options), "error: no_such_option")
        self.expect(INPUT_HAS_ERRORS, self.edsc("generate", self.write("empty.eds", "[FileInfo]\n"), "-o", self.output,
                                                "--keep-going"), "error:", "[no-objects]")

    def test_keep_going_makes_opaque_bytes_of_an_unknown_type(self) -> None:
        """A master can still transfer the bytes of a type that only the vendor knows, as a DOMAIN."""
        for line in ("DataType=0x99", "DataType=float", "Denotation=x"):
            sheet = self.write("odd.eds", SMALL + f"[2100]\nParameterName=Odd\nObjectType=7\n{line}\nAccessType=rw\n")
            self.expect(INPUT_HAS_ERRORS, self.edsc("generate", sheet, "-o", self.output), "error: ", "[data-type]", "--keep-going")
            result = self.edsc("generate", sheet, "-o", self.output, "--keep-going")
            self.expect(FINE, result, "warning: ", "[data-type]")
            self.assertNotIn("skipped: ", result.stderr)
            self.assertRegex((self.output / "odd/dictionary.hpp").read_text(), r"odd.*Domain")
            device = json.loads(self.edsc("dump", sheet, "--keep-going").stdout)
            entry = next(row for row in device["objects"] if row["index"] == 0x2100)["entries"][0]
            self.assertEqual(entry["data_type"], "DOMAIN")

    def test_says_each_thing_that_is_left_out(self) -> None:
        wrong = self.write("wrong.eds", WRONG.read_text() + "[2100]\nParameterName=Odd\nObjectType=7\nDataType=0x99\n"
                           "AccessType=rw\nDefaultValue=5\n[2101]\nParameterName=Even\nObjectType=7\nDataType=5\nAccessType=rw\n"
                           "DefaultValue=x\n")
        result = self.edsc("generate", wrong, "-o", self.output, "--keep-going")
        said = [line.split("skipped: ")[1] for line in result.stderr.splitlines() if "skipped: " in line]
        self.assertEqual(said, ['the DefaultValue of 2100h:00 "Odd"', 'the DefaultValue of 2101h:00 "Even"',
                                "the default mapping of TPDO 1"])

    def test_says_that_a_pdo_with_a_restricted_cob_id_is_left_out(self) -> None:
        text = (FIXTURES / "pdo_device.eds").read_text()
        start = text.index("DefaultValue=", text.index("[1800sub1]"))
        wrong = self.write("wrong.eds", text[:start] + "DefaultValue=$NODEID+0x580\n" + text[text.index("\n", start) + 1:])
        result = self.edsc("generate", wrong, "-o", self.output, "--keep-going")
        self.expect(FINE, result, "[cob-id-restricted]", "skipped: TPDO 1\n")

    def test_an_error_cannot_be_silenced(self) -> None:
        wrong = self.write("wrong.eds", WRONG.read_text())
        self.write("wrong.options.json", '{"silence": ["pdo-size"]}')
        self.expect(FINE, self.edsc("check", wrong))
        self.expect(INPUT_HAS_ERRORS, self.edsc("generate", wrong, "-o", self.output), "[pdo-size]")
        self.assertEqual(snapshot(self.output), {})
        self.expect(FINE, self.edsc("generate", wrong, "-o", self.output, "--keep-going"),
                    "skipped: the default mapping of TPDO 1")

    def test_a_silenced_warning_does_not_hide_what_is_left_out(self) -> None:
        sheet = self.write("off.eds", WRONG.read_text().replace("$NODEID+0x180", "$NODEID+0x80000180"))
        self.expect(FINE, self.edsc("generate", sheet, "-o", self.output), "the PDO is disabled by default and ignored")
        self.write("off.options.json", '{"silence": ["pdo-size"]}')
        result = self.edsc("generate", sheet, "-o", self.output)
        self.expect(FINE, result, "skipped: the default mapping of TPDO 1")
        self.assertNotIn("[pdo-size]", result.stderr)

    def test_with_static_mapping_keeps_the_mapping_in_flash(self) -> None:
        sheet = FIXTURES / "dynamic_mapping.eds"
        for extra in ((), ("--static-mapping",)):
            self.expect(FINE, self.edsc("generate", sheet, "-o", self.output, *extra))
            text = (self.output / "dynamic_mapping/dictionary.hpp").read_text()
            in_ram = text[text.index("struct Values"):text.index("struct Constants")]
            self.assertEqual("MappingParameter rpdo_mapping_parameter_1;" in in_ram, not extra)
        self.assertNotIn("canopen::Tpdo<>", (self.output / "dynamic_mapping/device.hpp").read_text())

    def test_with_a_node_id_has_no_formula(self) -> None:
        self.edsc("generate", GOOD, "-o", self.output, "--node-id", 5, "--name", "axis")
        text = (self.output / "axis/dictionary.hpp").read_text()
        self.assertIn("0x00000085", text)
        self.assertNotIn("NodeIdRelative", text)

    def test_depfile_names_outputs_and_inputs(self) -> None:
        folder = self.folder / "a $ b#"
        folder.mkdir()
        sheet = folder / "small.eds"
        sheet.write_text(SMALL)
        (folder / "small.options.json").write_text("{}")
        self.expect(FINE, self.edsc("generate", sheet, "-o", "out", "--depfile", "out/small.d"))
        text = (self.output / "small.d").read_text()
        escaped = str(folder).replace(" ", "\\ ").replace("$", "$$").replace("#", "\\#")
        self.assertEqual(text, " ".join(f"out/small/{header}" for header in HEADERS + MEANING_HEADERS) +
                         f": \\\n  {escaped}/small.eds \\\n  {escaped}/small.options.json\n")

    def test_templates_of_ones_own_replace_the_built_in_ones(self) -> None:
        templates = self.folder / "mine"
        templates.mkdir()
        (templates / "pdo.hpp.mustache").write_text("// {{namespace}}\n")
        self.expect(FINE, self.edsc("generate", GOOD, "-o", self.output, "--templates", templates))
        self.assertEqual((self.output / "every_type/pdo.hpp").read_text(), "// every_type\n")
        (templates / "pdo.hpp.mustache").write_text("{{#open}}\n{{/open}}{{namespce}}\n")
        self.expect(WRONG_USAGE, self.edsc("generate", GOOD, "-o", "other", "--templates", templates),
                    f"edsc: {templates}/pdo.hpp.mustache: {{{{open}}}}: the view does not have this name\n")
        (templates / "pdo.hpp.mustache").write_text("{{#namespace}}\n")
        self.expect(WRONG_USAGE, self.edsc("generate", GOOD, "-o", "other", "--templates", templates),
                    f"edsc: {templates}/pdo.hpp.mustache: ")
        (templates / "pdo.hpp.mustache").rename(templates / "pdo.hp.mustache")
        self.expect(WRONG_USAGE, self.edsc("generate", GOOD, "-o", "other", "--templates", templates),
                    f"edsc: {templates}/pdo.hp.mustache: there is no built-in template with this name; did you mean "
                    '"pdo.hpp.mustache"?\n')
        self.assertFalse((self.folder / "other").exists())
        (templates / "pdo.hp.mustache").rename(templates / ".pdo.hp.mustache.swp")
        self.expect(FINE, self.edsc("generate", GOOD, "-o", self.output, "--templates", templates))


class Check(CommandLine):
    def test_says_nothing_of_a_good_data_sheet(self) -> None:
        result = self.edsc("check", SOURCE_DIR / "eds/ezd-1136.eds")
        self.expect(FINE, result)
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_tells_its_findings_on_standard_output(self) -> None:
        result = self.edsc("check", WRONG)
        self.expect(INPUT_HAS_ERRORS, result)
        self.assertIn("[pdo-size]", result.stdout)
        self.assertEqual(result.stderr, "")

    def test_generate_tells_them_on_standard_error(self) -> None:
        result = self.edsc("generate", WRONG, "-o", self.output)
        self.expect(INPUT_HAS_ERRORS, result)
        self.assertIn("[pdo-size]", result.stderr)
        self.assertEqual(result.stdout, "")

    def test_dump_shows_a_broken_pdo_and_says_why(self) -> None:
        result = self.edsc("dump", WRONG)
        self.expect(FINE, result, "[pdo-size]")
        self.assertTrue(any(pdo["broken"] for pdo in json.loads(result.stdout)["pdos"]))

    def test_every_command_sees_the_device_that_check_describes(self) -> None:
        sheet = self.write("limits.eds", SMALL + "[2000]\nParameterName=Value\nObjectType=7\nDataType=6\nAccessType=rw\n"
                                                 "LowLimit=1000\nHighLimit=10\n")
        self.expect(FINE, self.edsc("check", sheet), "neither is checked")
        dumped = self.edsc("dump", sheet, "--cpp")
        self.expect(FINE, dumped, "[limits-order]")
        device = json.loads(dumped.stdout)
        entry = next(row for row in device["objects"] if row["index"] == 0x2000)["entries"][0]
        self.assertFalse({"low_limit", "high_limit"} & set(entry))
        nobody = "socketcand:127.0.0.1:1/none"  # a value outside the limits is rejected before the bus is opened
        self.assertNotIn("limit", self.edsc("write", nobody, "5", "2000h", "500", "--eds", sheet).stderr)
        good = self.write("good.eds", sheet.read_text().replace("HighLimit=10\n", "HighLimit=2000\n"))
        self.assertIn("below the low limit", self.edsc("write", nobody, "5", "2000h", "500", "--eds", good).stderr)

    def test_keep_going_makes_warnings_of_errors(self) -> None:
        self.expect(INPUT_HAS_ERRORS, self.edsc("check", WRONG), "error: ", "[pdo-size]")
        result = self.edsc("check", WRONG, "--keep-going")
        self.expect(FINE, result, "warning: ", "[pdo-size]", "skipped: the default mapping of TPDO 1")
        self.assertNotIn("error: ", result.stdout)
        self.expect(INPUT_HAS_ERRORS, self.edsc("check", WRONG, "--keep-going", "--strict"))

    def test_takes_the_worst_of_several_files(self) -> None:
        self.expect(INPUT_HAS_ERRORS, self.edsc("check", GOOD, WRONG, GOOD))
        self.expect(WRONG_USAGE, self.edsc("check", WRONG, "missing.eds", GOOD))

    def test_strict_makes_errors_of_warnings(self) -> None:
        sheet = self.write("small.eds", SMALL.replace("SubNumber=2", "SubNumber=9"))
        self.expect(FINE, self.edsc("check", sheet), "warning:")
        self.expect(INPUT_HAS_ERRORS, self.edsc("check", sheet, "--strict"), "error:", "[sub-number]")

    def test_silence_drops_a_rule(self) -> None:
        self.expect(FINE, self.edsc("check", WRONG, "--silence", "pdo-size"))
        self.expect(INPUT_HAS_ERRORS, self.edsc("check", WRONG, "--silence", "pdo-length"))

    def test_json_has_stable_keys(self) -> None:
        result = self.edsc("check", WRONG, GOOD, "--format", "json")
        self.expect(INPUT_HAS_ERRORS, result)
        report = json.loads(result.stdout)
        self.assertEqual(set(report), {"schema", "diagnostics", "allowed_diagnostics", "suppressed", "left_out", "causes", "errors",
                                       "warnings", "notes", "allowed"})
        self.assertEqual((report["schema"], report["errors"]), (2, 1))
        (finding,) = (row for row in report["diagnostics"] if row["severity"] == "error")
        self.assertEqual(set(finding), {"file", "line", "column", "length", "severity", "rule", "message", "notes"})
        self.assertEqual((finding["rule"], finding["severity"], finding["column"]), ("pdo-size", "error", 14))

    def test_json_of_many_findings_counts_the_rest(self) -> None:
        sheet = self.write("many.eds", SMALL + "stray\n" * 60)
        report = json.loads(self.edsc("check", sheet, "--format", "json").stdout)
        self.assertEqual([(row["rule"], row["count"]) for row in report["suppressed"]], [("stray-line", 10)])
        self.assertEqual(report["warnings"], 60)

    def test_lists_every_rule(self) -> None:
        result = self.edsc("check", "--list-rules")
        self.expect(FINE, result, "pdo-size", "number-format")


class Dump(CommandLine):
    def test_is_json_with_the_whole_device(self) -> None:
        result = self.edsc("dump", GOOD)
        self.expect(FINE, result)
        device = json.loads(result.stdout)
        self.assertEqual(device["schema"], 2)
        self.assertEqual(device["name"], "every_type")
        self.assertEqual(device["product_name"], "Every type")
        objects = {row["index"]: row for row in device["objects"]}
        self.assertEqual(objects[0x2015]["entries"][0]["default_value"], -(2**63))
        self.assertEqual(objects[0x201B]["entries"][0]["default_value"], 2**64 - 1)
        self.assertEqual(objects[0x200A]["entries"][0]["default_value"], "00FF7F")
        self.assertEqual(objects[0x1014]["entries"][0]["default_value"], "$NODEID+0x80")
        self.assertEqual([(pdo["direction"], pdo["number"], pdo["bits"]) for pdo in device["pdos"]],
                         [("receive", 1, 40), ("transmit", 1, 41), ("transmit", 2, 64)])

    def test_with_a_node_id_holds_numbers(self) -> None:
        device = json.loads(self.edsc("dump", GOOD, "--node-id", 5).stdout)
        self.assertEqual(device["node_id"], 5)
        self.assertNotIn("$NODEID", json.dumps(device["objects"]))

    def test_with_cpp_holds_what_the_templates_see(self) -> None:
        device = json.loads(self.edsc("dump", GOOD, "--cpp").stdout)
        self.assertEqual(device["cpp"]["namespace"], "every_type")

    def test_has_identifiers_without_the_reserved_words_of_a_language(self) -> None:
        device = json.loads(self.edsc("dump", names_eds(self.folder), "--cpp").stdout)
        first = next(row for row in device["objects"] if row["name"] == "class")
        self.assertEqual(first["identifier"], "class")
        self.assertIn("class_", [row["var"]["identifier"] for row in device["cpp"]["types"] if row["var"]])

    def test_of_names_in_other_scripts_is_json(self) -> None:
        device = json.loads(self.edsc("dump", names_eds(self.folder)).stdout)
        self.assertIn("速度", [row["name"] for row in device["objects"]])

    def test_that_cannot_be_written_is_no_success(self) -> None:
        if not os.path.exists("/dev/full"):
            self.skipTest("SKIPPED: no /dev/full")
        with open("/dev/full", "w") as full:
            result = subprocess.run([EDSC, "dump", GOOD], stdout=full, stderr=subprocess.PIPE, text=True, timeout=600)
        self.assertEqual(result.returncode, WRONG_USAGE)


class Colour(CommandLine):
    def test_is_off_when_no_terminal_listens(self) -> None:
        self.assertNotIn(ESCAPE, self.edsc("check", WRONG).stdout)

    def test_always_and_never(self) -> None:
        self.assertIn(ESCAPE, self.edsc("check", WRONG, "--color", "always").stdout)
        self.assertNotIn(ESCAPE, self.edsc("check", WRONG, "--color", "never").stdout)

    def on_a_terminal(self, environment: dict[str, str]) -> str:
        ours, theirs = os.openpty()
        try:
            subprocess.run([EDSC, "check", WRONG], stdout=theirs, timeout=600, env={**os.environ, **environment})
            return os.read(ours, 65536).decode(errors="replace")
        finally:
            os.close(ours)
            os.close(theirs)

    def test_is_on_at_a_terminal_unless_no_color_says_otherwise(self) -> None:
        os.environ.pop("NO_COLOR", None)
        self.assertIn(ESCAPE, self.on_a_terminal({}))
        self.assertNotIn(ESCAPE, self.on_a_terminal({"NO_COLOR": "1"}))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)
