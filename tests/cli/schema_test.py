#!/usr/bin/env python3
"""The schemas of docs/schema describe the output of edsc, such as `edsc dump` for all EDS files, and reject wrong input. The
files of the repository that are input are checked by tests/gates/schemas.py.

    schema_test.py SOURCE_DIR EDSC [unittest arguments]

The files of vendors are not part of this repository; without them (see corpus_test.py) that part is skipped.
"""

from __future__ import annotations

import json
import subprocess
import sys
import unittest
from collections.abc import Iterable
from pathlib import Path

import jsonschema
from cli_test import EDSC, FINE, FIXTURES, SMALL, SOURCE_DIR, CommandLine
from made_fixtures import names_eds

sys.path.insert(0, str(SOURCE_DIR / "tests/corpus"))
from corpus_test import find_corpus  # noqa: E402

SCHEMAS = SOURCE_DIR / "docs/schema"
SUFFIXES = (".eds", ".dcf", ".xdd", ".xdc")
TPDO = """[1800]
ParameterName=TPDO communication parameter
ObjectType=9
SubNumber=5
[1800sub0]
ParameterName=Highest sub-index supported
DataType=5
AccessType=const
DefaultValue=6
[1800sub1]
ParameterName=COB-ID
DataType=7
AccessType=rw
DefaultValue=$NODEID+0x40000180
[1800sub2]
ParameterName=Transmission type
DataType=5
AccessType=rw
DefaultValue=254
ParameterValue=1
[1800sub3]
ParameterName=Inhibit time
DataType=6
AccessType=rw
DefaultValue=10
[1800sub5]
ParameterName=Event timer
DataType=6
AccessType=rw
DefaultValue=500
[1A00]
ParameterName=TPDO mapping parameter
ObjectType=9
SubNumber=1
[1A00sub0]
ParameterName=Number of mapped objects
DataType=5
AccessType=const
DefaultValue=0
"""


def validator(name: str) -> jsonschema.Draft202012Validator:
    return jsonschema.Draft202012Validator(json.loads((SCHEMAS / f"{name}.schema.json").read_text()))


class Options(unittest.TestCase):
    def test_that_are_wrong_do_not(self) -> None:
        for wrong in ({"no_such_member": 1}, {"settable": 1}, {"names": {"1017": "Not A Name"}}, {"sdo": 1},
                      {"sdo": {"no_such_member": 1}}, {"sdo": {"timeout": "5"}}, {"sdo_timeout": "5"}):
            with self.assertRaises(jsonschema.ValidationError):
                validator("options").validate(wrong)

    def test_may_have_their_deprecated_names(self) -> None:
        validator("options").validate({"sdo_timeout": 5, "storing": {"6010h:01": "never"}, "pdo": {"mpdo": True}})


class Deviations(unittest.TestCase):
    def test_that_are_wrong_do_not(self) -> None:
        for wrong in ({"case": "3.7"}, {"case": "3.*", "reason": "x"}, {"case": "3.7", "reason": " "},
                      {"case": "3.7", "reason": "x", "object": "speed"}, {"case": "3.7", "reason": "x", "why": "y"}):
            with self.assertRaises(jsonschema.ValidationError):
                validator("deviations").validate({"deviations": [wrong]})


class Behaviours(unittest.TestCase):
    def test_that_are_wrong_do_not(self) -> None:
        event = {"time": "1s"}
        for wrong in ({"rule": []}, {"generate": {"6064h": "rmap 0 1 5s"}}, {"copy": [{"from": "6064h"}]},
                      {"rules": [{"on": event}]}, {"rules": [{"on": {**event, "read": "6064h"}, "do": []}]},
                      {"rules": [{"on": event, "do": ["get 6064h"]}]}, {"rules": [{"on": event, "do": [], "after": "soon"}]}):
            with self.assertRaises(jsonschema.ValidationError):
                validator("behaviour").validate(wrong)

    def test_of_the_document_is_right(self) -> None:
        validator("behaviour").validate({"set": {"6041h": 592}, "generate": {"6064h": "ramp 0 1000 5s"},
                                         "copy": [{"from": "60FFh", "to": "606Ch", "after": "200 ms"}],
                                         "rules": [{"name": "x", "on": {"sync": 3}, "refuse": "0609 0031h", "once": True}]})


class Dump(CommandLine):
    def check(self, paths: Iterable[Path], *options: str) -> int:
        device = validator("device")
        count = 0
        for path in paths:
            with self.subTest(path=path):
                result = subprocess.run([EDSC, "dump", path, "--keep-going", *options], capture_output=True, timeout=600)
                if result.stdout:
                    device.validate(json.loads(result.stdout))
                    count += 1
        return count

    def test_of_the_reference_devices_fits(self) -> None:
        self.assertEqual(self.check((SOURCE_DIR / "eds").glob("*.eds")), 8)
        self.assertEqual(self.check((SOURCE_DIR / "eds").glob("*.eds"), "--node-id", "5", "--cpp"), 8)

    def test_of_the_fixtures_fits(self) -> None:
        paths = [names_eds(self.folder), *(path for path in FIXTURES.iterdir() if path.suffix in SUFFIXES)]
        self.assertGreaterEqual(self.check(paths), 20)

    def test_of_vendors_files_fits(self) -> None:
        corpus = find_corpus(SOURCE_DIR)
        if corpus is None:
            self.skipTest("SKIPPED: no corpus; EDSC_CORPUS names one")
        paths = sorted(path for path in corpus.rglob("*") if path.suffix.lower() in SUFFIXES)
        self.assertGreaterEqual(self.check(paths), 130)

    def dump(self, name: str, text: str, *options: str) -> dict:
        result = self.edsc("dump", self.write(name, text), *options)
        self.expect(FINE, result)
        device = json.loads(result.stdout)
        validator("device").validate(device)
        return device

    def test_shows_default_and_parameter_value_of_a_dcf(self) -> None:
        text = SMALL.replace("DataType=6\nAccessType=rw", "DataType=6\nAccessType=rw\nDefaultValue=100\nParameterValue=200")
        heartbeat = self.entry(self.dump("node.dcf", text), 0x1017, 0)
        self.assertEqual((heartbeat["default_value"], heartbeat["parameter_value"]), (100, 200))
        without_default = self.entry(self.dump("node.dcf", text.replace("DefaultValue=100\n", "")), 0x1017, 0)
        self.assertNotIn("default_value", without_default)
        self.assertEqual(without_default["parameter_value"], 200)
        in_eds = self.entry(self.dump("node.eds", text), 0x1017, 0)
        self.assertEqual(in_eds["default_value"], 100)
        self.assertNotIn("parameter_value", in_eds)

    def test_shows_the_communication_parameters_of_pdos(self) -> None:
        text = SMALL + TPDO
        pdo = self.dump("pdo.eds", text)["pdos"][0]
        expected = {"valid": True, "cob_id": "$NODEID+0x40000180", "transmission_type": 254, "inhibit_time": 10,
                    "event_timer": 500}
        self.assertEqual({key: pdo[key] for key in expected}, expected)
        self.assertNotIn("sync_start_value", pdo)
        of_node = self.dump("pdo.dcf", text, "--node-id", "5")["pdos"][0]
        self.assertEqual((of_node["cob_id"], of_node["transmission_type"]), (0x40000185, 1))
        off = self.dump("pdo.eds", text.replace("$NODEID+0x40000180", "0x80000000"))["pdos"][0]
        self.assertFalse(off["valid"])

    @staticmethod
    def entry(device: dict, index: int, sub_index: int) -> dict:
        return next(entry for entry in next(one for one in device["objects"] if one["index"] == index)["entries"]
                    if entry["sub_index"] == sub_index)


class OfCheckAndDiff(CommandLine):
    def check(self, *arguments: object) -> dict:
        found = json.loads(self.edsc("check", "--format", "json", *arguments).stdout)
        validator("check").validate(found)
        return found

    def test_findings_of_all_files_fit(self) -> None:
        found = self.check(*sorted((SOURCE_DIR / "eds").glob("*.eds")), *sorted(FIXTURES.glob("*.eds")),
                           names_eds(self.folder))
        self.assertTrue(found["diagnostics"])

    def test_allowed_findings_and_what_is_left_out_fit(self) -> None:
        text = SMALL.replace("DataType=6\nAccessType=rw", "DataType=6\nAccessType=rw\nDefaultValue=x").replace(
            "[1017]", "; edsc: allow unknown-key - known\n[1017]\nColour=red")
        found = self.check(self.write("small.eds", text), "--keep-going")
        self.assertEqual([row["what"] for row in found["left_out"]], ['the DefaultValue of 1017h:00 "Producer heartbeat time"'])
        self.assertEqual([row["allowance"]["reason"] for row in found["allowed_diagnostics"]], ["known"])

    def test_of_diff_fits(self) -> None:
        sheets = sorted(FIXTURES.glob("*.eds"))[:6]
        for one, other in zip(sheets, sheets[1:]):
            changes = json.loads(self.edsc("diff", one, other, "--format", "json", "--keep-going").stdout)
            validator("diff").validate(changes)
            self.assertEqual(changes["breaking"] + changes["compatible"], len(changes["changes"]))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
