#!/usr/bin/env python3
"""`edsc format`: several files, other node-IDs, and EDS files from XDD files; the hooks for pre-commit.

    format_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import gzip
import json
import os
import re
import shlex
import subprocess
import sys
import unittest
from pathlib import Path

from cli_test import CLEAN, EDSC, FINE, INPUT_HAS_ERRORS, SMALL, SOURCE_DIR, WRONG_USAGE, CommandLine

sys.path.insert(0, str(SOURCE_DIR / "tests/corpus"))
from corpus_test import find_corpus  # noqa: E402

XDD = SOURCE_DIR / "examples/xdd/drive.xdd"
XDC = SOURCE_DIR / "examples/xdd/drive_node_5.xdc"


class ManyFiles(CommandLine):
    def setUp(self) -> None:
        super().setUp()
        self.rough = self.write("rough.eds", SMALL)
        self.canonical = self.write("canonical.eds", self.edsc("format", self.rough).stdout)

    def test_check_lists_those_that_are_not_canonical(self) -> None:
        other = self.write("other.eds", SMALL.replace("=", " = "))
        result = self.edsc("format", "--check", self.rough, self.canonical, other)
        self.expect(INPUT_HAS_ERRORS, result, f"{self.rough}:", f"{other}:")
        self.assertNotIn(str(self.canonical), result.stderr)
        self.expect(FINE, self.edsc("format", "--check", self.canonical, self.canonical))

    def test_check_takes_the_worst_of_several(self) -> None:
        self.expect(WRONG_USAGE, self.edsc("format", "--check", self.rough, "none.eds", self.canonical), "rough", "none.eds")

    def test_in_place_writes_each_file(self) -> None:
        before = self.canonical.stat().st_mtime_ns
        self.expect(FINE, self.edsc("format", "--in-place", self.rough, self.canonical))
        self.assertEqual(self.rough.read_text(), self.canonical.read_text())
        self.assertEqual(self.canonical.stat().st_mtime_ns, before)
        self.expect(FINE, self.edsc("format", "-i", self.rough))

    def test_in_place_leaves_a_file_with_errors_alone(self) -> None:
        broken = self.write("broken.eds", "[1000\nParameterName=x\n")
        self.expect(INPUT_HAS_ERRORS, self.edsc("format", "-i", broken, self.rough), "unterminated-section")
        self.assertEqual(broken.read_text(), "[1000\nParameterName=x\n")
        self.assertEqual(self.rough.read_text(), self.canonical.read_text())

    def test_need_a_place_to_go_to(self) -> None:
        self.expect(WRONG_USAGE, self.edsc("format", self.rough, self.canonical), "several files need --check or --in-place")
        self.expect(WRONG_USAGE, self.edsc("format", "-i", "-"), "standard input cannot be written")
        self.expect(WRONG_USAGE, self.edsc("format", "-i", self.rough, "-o", "x.eds"), "cannot be combined with")


class OtherBytes(CommandLine):
    """Files that are not UTF-8 text."""

    def setUp(self) -> None:
        super().setUp()
        self.text = self.edsc("format", self.write("rough.eds", SMALL.replace("Device type", "Gerätetyp"))).stdout

    def sheet(self, name: str, content: bytes) -> Path:
        path = self.folder / name
        path.write_bytes(content)
        return path

    def test_a_gzip_file_stays_one(self) -> None:
        for text in (self.text, SMALL):
            packed = self.sheet("packed.eds", gzip.compress(text.encode()))
            before = packed.read_bytes()
            self.expect(WRONG_USAGE, self.edsc("format", "-i", packed), "a gzip file is not replaced by its text")
            self.expect(WRONG_USAGE, self.edsc("format", packed, "-o", packed), "a gzip file is not replaced by its text")
            self.expect(INPUT_HAS_ERRORS, self.edsc("format", "--check", packed), "packed.eds:")
            self.assertEqual(packed.read_bytes(), before)
        self.expect(FINE, self.edsc("format", packed, "-o", "text.eds"))
        self.assertTrue((self.folder / "text.eds").read_text().startswith("[FileInfo]\n"))

    def test_a_canonical_gzip_file_is_not_canonical(self) -> None:
        packed = self.sheet("packed.eds", gzip.compress(self.text.encode()))
        self.expect(INPUT_HAS_ERRORS, self.edsc("format", "--check", packed), "the file is gzip; the canonical form is UTF-8")

    def test_another_encoding_is_reported(self) -> None:
        for name, encoding in (("CP1252", "cp1252"), ("UTF-16LE", "utf-16-le"), ("UTF-8 with a byte order mark", "utf-8-sig")):
            with self.subTest(encoding=name):
                sheet = self.sheet("a.eds", self.text.encode(encoding))
                self.expect(INPUT_HAS_ERRORS, self.edsc("format", "--check", sheet), f"the file is {name}; the canonical form")
                result = self.edsc("format", "-i", sheet)
                self.expect(FINE, result)
                self.assertEqual(f"converted from {name} to UTF-8" in result.stderr, encoding != "utf-8-sig", result.stderr)
                self.assertEqual(sheet.read_bytes(), self.text.encode())
                self.expect(FINE, self.edsc("format", "--check", sheet))


    def test_a_file_is_not_replaced_by_a_guess(self) -> None:
        texts = {"モータ電流": "cp932", "电机电流": "gb18030", "W\u00fcrzburg": "cp437"}
        for text, encoding in texts.items():
            for place in (("-i",), ("-o", "a.eds")):
                with self.subTest(encoding=encoding, place=place):
                    sheet = self.sheet("a.eds", SMALL.encode() + f"; {text}\n".encode(encoding))
                    before = sheet.read_bytes()
                    self.expect(INPUT_HAS_ERRORS, self.edsc("format", sheet, *place), "--encoding names")
                    self.assertEqual(sheet.read_bytes(), before)
            with self.subTest(encoding=encoding):
                sheet = self.sheet("a.eds", SMALL.encode() + f"; {text}\n".encode(encoding))
                self.expect(FINE, self.edsc("format", "--encoding", encoding, "-i", sheet), "to UTF-8")
                self.assertIn(f"; {text}\n", sheet.read_text(encoding="utf-8"))

    def test_an_unknown_encoding_is_named_with_its_bytes_and_candidates(self) -> None:
        sheet = self.sheet("a.eds", SMALL.encode() + "; モータ電流\n".encode("cp932"))
        result = self.edsc("check", sheet)
        self.assertIn("bytes 83h 82h 81h are not ASCII, and the encoding is not known; the text is valid Shift-JIS", result.stdout)
        self.assertIn('option "encoding" names the encoding [unknown-encoding]', result.stdout)

    def test_options_that_would_be_wrong_for_the_result_are_reported(self) -> None:
        sheet = self.sheet("a.eds", SMALL.encode() + "; 电机电流\n".encode("gb18030"))
        self.write("a.options.json", '{"encoding": "GB18030"}')
        self.expect(WRONG_USAGE, self.edsc("format", "-i", sheet), "states how this file is read")
        self.assertIn("; 电机电流\n", self.edsc("format", sheet).stdout)

    def test_decimal_sub_indices_and_swapped_access_types_become_those_of_cia_306(self) -> None:
        array = "[2022]\nParameterName=A\nObjectType=0x8\nSubNumber=2\n[2022sub0]\nParameterName=N\nDataType=5\nAccessType=ro\n"
        array += "[2022sub10]\nParameterName=B\nDataType=5\nAccessType=rww\nPDOMapping=1\n"
        sheet = self.write("a.eds", SMALL + array)
        made = self.edsc("format", "--sub-indices", "decimal", "--access-types", "swapped", sheet).stdout
        self.assertRegex(made, r"\[2022subA\]\nParameterName=B\n(.*\n)*?AccessType=rwr\n")
        self.expect(WRONG_USAGE, self.edsc("format", "--sub-indices", "octal", sheet), "hexadecimal or decimal")


class Comments(CommandLine):
    def test_that_allow_findings_of_the_file_stay_at_its_top(self) -> None:
        first, rest = re.search(r"(\[FileInfo\].*?)(\[.*)", SMALL, re.DOTALL).groups()
        path = self.write("a.eds", "; edsc: allow file-name - sent so\n; what follows\n" + rest + first)
        result = self.edsc("format", path)
        self.expect(FINE, result)
        self.assertTrue(result.stdout.startswith("; edsc: allow file-name - sent so\n\n[FileInfo]\n"), result.stdout[:200])
        self.assertIn("\n; what follows\n[DeviceInfo]\n", result.stdout)
        self.assertEqual(self.edsc("format", self.write("b.eds", result.stdout)).stdout, result.stdout)

    def test_that_allow_findings_of_a_section_do_not_become_those_of_the_file(self) -> None:
        first, rest = re.search(r"(\[FileInfo\].*?)(\[.*)", SMALL, re.DOTALL).groups()
        first = first.replace("[FileInfo]\n", "")
        comments = "; edsc: allow file-name - x; y ; edsc: allow eds-version - as well"
        inputs = {
            "moved to the top": rest + comments.replace(" ; ", "\n; ") + "\n[FileInfo]\n" + first,
            "on its line": f"[FileInfo] {comments}\n" + first + rest,
            "of a duplicate section": "[FileInfo]\n" + first + rest + comments.replace(" ; ", "\n; ") + "\n[FileInfo]\n" + first,
        }
        for name, text in inputs.items():
            with self.subTest(name):
                made = self.edsc("format", self.write("a.eds", text)).stdout
                self.assertTrue(made.startswith(f"[FileInfo] {comments}\n"), made[:200])
                self.assertEqual(self.edsc("format", self.write("b.eds", made)).stdout, made)

    def test_on_the_line_of_a_section_that_moves_go_before_it(self) -> None:
        first, rest = re.search(r"(\[FileInfo\].*?)(\[.*)", SMALL, re.DOTALL).groups()
        rest = rest.replace("[DeviceInfo]\n", "[DeviceInfo] ; edsc: allow a - b ; edsc: allow c - d\n", 1)
        made = self.edsc("format", self.write("a.eds", rest + first)).stdout
        self.assertIn("\n; edsc: allow a - b\n; edsc: allow c - d\n[DeviceInfo]\n", made)
        self.assertTrue(made.startswith("[FileInfo]\n"), made[:200])

    def test_of_the_file_stay_at_the_top_of_a_dcf_without_file_info(self) -> None:
        rest = re.search(r"\[MandatoryObjects\].*", SMALL, re.DOTALL).group()
        text = "; edsc: allow no-device-info - of the file\n" + rest
        made = self.edsc("format", self.write("a.eds", text), "--dcf", "--node-id", 5).stdout
        self.assertTrue(made.startswith("; edsc: allow no-device-info - of the file\n\n[DeviceComissioning]\n"), made[:200])


class AnotherNode(CommandLine):
    """The node-ID-dependent values of a DCF change with its node-ID."""

    def make(self, node: int, source: Path, *options: object) -> str:
        result = self.edsc("format", source, "--dcf", "--node-id", node, *options)
        self.expect(FINE, result)
        return result.stdout

    def test_has_its_own_can_ids(self) -> None:
        for options in ((), ("--all",)):
            five = self.write("five.dcf", self.make(5, SOURCE_DIR / "eds/cpd.eds", *options))
            seven = self.make(7, SOURCE_DIR / "eds/cpd.eds", *options)
            self.assertEqual(self.make(7, five, *options), seven)

    def test_keeps_flags_and_what_was_configured(self) -> None:
        five = self.make(5, SOURCE_DIR / "eds/cpd.eds", "--all")
        five = re.sub(r"(\[1800sub1\][^[]*ParameterValue=)0x\w+", r"\g<1>0xC0000185", five)
        five = re.sub(r"(\[1017\][^[]*ParameterValue=)\w+", r"\g<1>1234", five)
        moved = self.make(7, self.write("five.dcf", five))
        self.assertRegex(moved, r"\[1800sub1\][^[]*ParameterValue=0xC0000187")
        self.assertRegex(moved, r"\[1017\][^[]*ParameterValue=1234")
        self.assertNotRegex(moved, r"\[1400sub1\][^[]*ParameterValue=0x\w")

    def test_moves_signed_numbers_too(self) -> None:
        """INTEGER16 $NODEID+0xFF00 is -251 for node 5 and -247 for node 9."""
        five = self.make(5, SOURCE_DIR / "tests/fixtures/every_type.eds", "--all")
        moved = self.make(9, self.write("five.dcf", five), "--all")
        values = [re.search(r"\[2805\][^[]*ParameterValue=(\w+)\n", text)[1] for text in (five, moved)]
        self.assertEqual(values, ["0xFF05", "0xFF09"])

    def test_moves_a_value_that_does_not_fit_for_each_node(self) -> None:
        """UNSIGNED8 $NODEID+0xF0: 0xF5 for node 5, 0xFF for node 15, and no value for node 16."""
        five = self.make(5, SOURCE_DIR / "eds/cpd.eds", "--all")
        five += ("\n[2FFF]\nParameterName=Address\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\n"
                 "DefaultValue=$NODEID+0xF0\nParameterValue=0xF5\n")
        source = self.write("five.dcf", five)
        self.assertIn("\nParameterValue=0xFF\n", self.edsc("format", source, "--dcf", "--node-id", 15, "--all").stdout)
        result = self.edsc("format", source, "--dcf", "--node-id", 16, "--all")
        self.assertIn("does not fit into UNSIGNED8 with node-ID 16", result.stderr)
        self.assertNotIn("ParameterValue=0x00\n", result.stdout)

    def test_is_said_where_a_cob_id_stays(self) -> None:
        five = self.make(5, SOURCE_DIR / "eds/cpd.eds", "--all")
        five = re.sub(r"(\[1400sub1\][^[]*DefaultValue=)[^\n]*", r"\g<1>0x205", five)
        five = re.sub(r"(\[1400sub1\][^[]*ParameterValue=)[^\n]*", r"\g<1>0x285", five)
        result = self.edsc("format", self.write("five.dcf", five), "--dcf", "--node-id", 7)
        self.assertIn("1400h:01 remains 0x00000285, a CAN-ID of node 5", result.stderr)
        self.assertIn("[cob-id-node-id]", result.stderr)

    def test_is_configured_by_its_concise_dcf(self) -> None:
        five = self.write("five.dcf", self.make(5, SOURCE_DIR / "eds/cpd.eds", "--all"))
        subprocess.run([EDSC, "format", five, "--concise", "--node-id", "7", "-o", self.folder / "seven.bin"], check=True)
        self.assertEqual((self.folder / "seven.bin").read_bytes()[:4], bytes(4))


def device_of(view: object) -> object:
    """A dump without the parts that EDS and XDD of the same device spell differently."""
    if isinstance(view, dict):
        return {key: device_of(value) for key, value in view.items()
                if key not in ("line", "column", "source", "file_name", "eds_version") and not key.endswith("_line")}
    if isinstance(view, list):
        return [device_of(element) for element in view]
    return " ".join(view.split()) if isinstance(view, str) else view


class FromXdd(CommandLine):
    def same_device(self, path: Path, suffix: str) -> subprocess.CompletedProcess[str]:
        target = self.folder / f"{path.stem}{suffix}"
        made = self.edsc("format", path, "-o", target)
        self.expect(FINE, made)
        self.expect(FINE, self.edsc("format", "--check", target))
        dumps = [device_of(json.loads(self.edsc("dump", one, "--keep-going").stdout)) for one in (path, target)]
        self.maxDiff = 4000
        self.assertEqual(dumps[0], dumps[1])
        compared = self.edsc("diff", path, target, "--keep-going", "--fail-on", "any")
        self.expect(FINE, compared, "0 breaking, 0 compatible")
        return made

    def test_makes_an_eds(self) -> None:
        made = self.same_device(XDD, ".eds")
        text = (self.folder / "drive.eds").read_text()
        for line in ("FileName=drive.eds", "EDSVersion=4.0", "[DummyUsage]", "DataType=0x0007", "DefaultValue=$NODEID+0x180"):
            self.assertIn(line, text)
        self.assertNotIn("ParameterValue", text)
        self.assertIn("DeviceIdentity/deviceFamily cannot be expressed in the EDS; ignored", made.stderr)
        self.assertIn("the attribute selfStartingDevice of CANopenGeneralFeatures cannot be expressed", made.stderr)
        self.assertNotIn("parameter/unit", made.stderr)

    def test_writes_the_unit_as_keys(self) -> None:
        empty = '<unit multiplier="1"/>'
        text = XDD.read_text(encoding="utf-8")
        self.assertEqual(text.count(empty), 1)
        unit = '<unit multiplier="0.1"><label lang="en">mm</label></unit>'
        made = self.same_device(self.write("speed.xdd", text.replace(empty, unit)), ".eds")
        self.assertNotIn("parameter/unit", made.stderr)
        written = (self.folder / "speed.eds").read_text()
        self.assertIn("Unit=mm", written)
        self.assertIn("Factor=0.1", written)

    def test_gives_an_array_the_keys_of_cia_306_only(self) -> None:
        """Other loaders of EDS files reject a DataType or an AccessType beside SubNumber."""
        array = 'name="Gains" objectType="8" subNumber="3"'
        text = XDD.read_text(encoding="utf-8")
        self.assertEqual(text.count(array), 1)
        xdd = self.write("gains.xdd", text.replace(array, f'{array} dataType="0008" accessType="rw" defaultValue="1" PDOmapping="no"'))
        self.same_device(xdd, ".eds")
        section = (self.folder / "gains.eds").read_text().split("[2002]\n")[1].split("\n\n")[0]
        self.assertEqual(section, "ParameterName=Gains\nObjectType=8\nSubNumber=3")

    def test_makes_a_dcf_of_an_xdc(self) -> None:
        self.same_device(XDC, ".dcf")
        text = (self.folder / "drive_node_5.dcf").read_text()
        for line in ("[DeviceComissioning]", "NodeID=5", "ParameterValue=1000"):
            self.assertIn(line, text)

    def test_makes_no_eds_of_the_values_of_a_node(self) -> None:
        self.expect(WRONG_USAGE, self.edsc("format", XDC, "-o", "axis.eds"), "name the output .dcf")
        self.assertFalse((self.folder / "axis.eds").exists())

    def test_makes_the_dcf_of_a_node(self) -> None:
        dcf = self.folder / "drive.dcf"
        self.expect(FINE, self.edsc("format", XDD, "--dcf", "--node-id", 7, "-o", dcf))
        self.expect(FINE, self.edsc("diff", XDD, dcf, "--node-id", 7, "--keep-going"))
        self.assertIn("NodeID=7", dcf.read_text())

    def test_is_not_written(self) -> None:
        sheet = self.write("pump.eds", SMALL)
        for options in ((), ("--dcf", "--node-id", 5), ("--concise",)):
            for name in ("pump.xdd", "pump.XDC"):
                with self.subTest(options=options, name=name):
                    result = self.edsc("format", sheet, *options, "-o", name)
                    self.expect(WRONG_USAGE, result, f"{name}: edsc reads XDD and XDC files, but does not write them")
                    self.assertIn("name the file .eds or .dcf", result.stderr)
                    self.assertFalse((self.folder / name).exists())
        result = self.edsc("save", "socketcan:none", 5, sheet, "-o", "pump.xdd")  # before the node is read
        self.expect(WRONG_USAGE, result, "edsc reads XDD and XDC files, but does not write them")

    def test_of_this_name_is_not_written_in_place(self) -> None:
        sheet = self.write("pump.xdd", SMALL)
        self.expect(WRONG_USAGE, self.edsc("format", "--in-place", sheet), f"{sheet}: edsc reads XDD and XDC files")
        self.assertEqual(sheet.read_text(), SMALL)

    def test_goes_to_standard_output(self) -> None:
        result = self.edsc("format", XDD)
        self.expect(FINE, result)
        self.assertIn("FileName=drive.eds\n", result.stdout)

    def test_has_no_canonical_form_of_its_own(self) -> None:
        for option in ("--check", "--in-place"):
            self.expect(INPUT_HAS_ERRORS, self.edsc("format", option, XDD), "does not have a canonical form")

    def test_of_vendors(self) -> None:
        corpus = find_corpus(SOURCE_DIR)
        paths = sorted([*corpus.rglob("*.xdd"), *corpus.rglob("*.xdc")]) if corpus else []
        if not paths:
            self.skipTest("SKIPPED: no corpus; EDSC_CORPUS names one")
        for path in paths:
            with self.subTest(path=path):
                self.same_device(path, ".dcf" if path.suffix == ".xdc" else ".eds")


class Hooks(CommandLine):
    """.pre-commit-hooks.yaml: its entries run as by pre-commit, followed by the names of the changed files."""

    def setUp(self) -> None:
        super().setUp()
        text = (SOURCE_DIR / ".pre-commit-hooks.yaml").read_text()
        fields = re.compile(r"^[- ] (\w+): *(.*)$", re.MULTILINE)
        self.hooks = {hook["id"]: hook for hook in
                      (dict(fields.findall("- id:" + part)) for part in text.split("\n- id:")[1:])}
        environment = {**os.environ, "GIT_CONFIG_GLOBAL": os.devnull}
        for name in ("a.eds", "b.eds"):
            self.write(name, self.edsc("format", CLEAN).stdout)
        for command in ("init -q", "add .", "-c user.name=a -c user.email=a@example.org commit -q -m one"):
            subprocess.run(["git", *command.split()], cwd=self.folder, check=True, env=environment)

    def hook(self, name: str, *files: str) -> subprocess.CompletedProcess[str]:
        entry = shlex.split(self.hooks[name]["entry"])
        self.assertEqual(entry[0], "edsc")
        for file in files:
            self.assertRegex(file, self.hooks[name]["files"])
        return self.edsc(*entry[1:], *json.loads(self.hooks[name]["args"].split(" #")[0]), *files)

    def test_all_are_complete(self) -> None:
        self.assertEqual(set(self.hooks), {"edsc-check", "edsc-format", "edsc-format-check", "edsc-diff"})
        for name, hook in self.hooks.items():
            self.assertLessEqual({"id", "name", "entry", "language", "files"}, set(hook), name)
            self.assertEqual(hook["language"], "system")
            self.assertIsNone(re.search(hook["files"], "drive.options.json"))

    def test_pass_on_good_files(self) -> None:
        for name in self.hooks:
            with self.subTest(hook=name):
                self.expect(FINE, self.hook(name, "a.eds", "b.eds"))

    def test_read_a_file_that_is_named_like_an_option(self) -> None:
        self.write("-h.eds", "not an EDS")
        self.expect(INPUT_HAS_ERRORS, self.hook("edsc-check", "a.eds", "-h.eds"), "-h.eds:1:1: error:")

    def test_find_what_is_wrong(self) -> None:
        rough = self.write("a.eds", "; a comment\n" + SMALL.replace("DataType=6\nAccessType=rw", "DataType=6\nAccessType=xy"))
        before = rough.read_text()
        self.expect(INPUT_HAS_ERRORS, self.hook("edsc-check", "a.eds", "b.eds"), "access-type")
        self.expect(INPUT_HAS_ERRORS, self.hook("edsc-format-check", "a.eds", "b.eds"), "a.eds:")
        self.assertEqual(rough.read_text(), before)
        self.expect(FINE, self.hook("edsc-format", "a.eds", "b.eds"))
        self.assertNotEqual(rough.read_text(), before)  # pre-commit stops when a hook changes a file
        self.write("a.eds", self.edsc("format", CLEAN).stdout.replace("AccessType=rw", "AccessType=ro", 1))
        self.expect(FINE, self.hook("edsc-diff", "a.eds", "b.eds"), "breaks master")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
