#!/usr/bin/env python3
"""edsc conform with a live node: the commands of docs/conform.md do what the page says, and the reports conform to their
schemas and can be read.

    conform_test.py SOURCE_DIR EDSC RK5C [unittest arguments]

RK5C is the program of the reference device. The blocks of the document that name this script are run in order in a copy of the
files that they use; the lines of blocks without a language must be in the output of the commands before them.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import jsonschema

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
RK5C = Path(sys.argv[3]).resolve()
sys.path.insert(0, str(SOURCE_DIR / "tests/support"))
from document_commands import run_document  # noqa: E402

ADDRESS = "socketcand:127.0.0.1:29536/vcan0"  # in the document
TIMEOUT = "--timeout 60s"  # for an answer that must be received, even on a busy machine


class Conform(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-conform-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copytree(SOURCE_DIR / "eds", self.folder / "eds")
        bus = self.start(EDSC, "bus", "--listen", "127.0.0.1:0")
        self.address = bus.stdout.readline().strip()
        self.assertRegex(self.address, "^socketcand:")
        node = self.start(RK5C, self.address, "--node-id", "5")
        while "pre-operational" not in (line := node.stdout.readline()):
            self.assertTrue(line, "the node has ended")

    def start(self, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen([*map(str, arguments)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT)

        def end() -> None:
            process.kill()
            process.communicate()

        self.addCleanup(end)
        return process

    def run_line(self, line: str) -> subprocess.CompletedProcess[str]:
        command = re.sub(rf"(edsc conform {ADDRESS} \S+ \S+)", rf"\1 {TIMEOUT}", line).replace(ADDRESS, self.address)
        environment = {**os.environ, "PATH": f"{EDSC.parent}{os.pathsep}{os.environ['PATH']}"}
        return subprocess.run(["bash", "-c", command], cwd=self.folder, env=environment, capture_output=True, text=True)

    def test_the_document(self) -> None:
        run_document(self, SOURCE_DIR / "docs/conform.md", "tests/cli/live/conform_test.py", self.run_line, 6)
        self.check_reports()

    def check_reports(self) -> None:
        report = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))
        schema = json.loads((SOURCE_DIR / "docs/schema/conform.schema.json").read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator(schema).validate(report)
        self.assertTrue(report["passed"])
        self.assertEqual(report["identity"]["differences"], None)
        self.assertGreater(report["verdicts"]["passed"], 10)

        suites = ElementTree.parse(self.folder / "report.xml").getroot()
        tests = suites.findall("testsuite/testcase")
        self.assertEqual(len(tests), int(suites.get("tests")))
        self.assertEqual(len(tests), len(report["cases"]) + 3)  # and the checks of the whole run
        self.assertEqual(len([test for test in tests if test.find("skipped") is not None]), int(suites.get("skipped")))

        log = (self.folder / "frames.log").read_text(encoding="utf-8").splitlines()
        # The log also has the frames between the cases.
        self.assertGreater(len(log), sum(len(case["frames"]) for case in report["cases"]))
        self.assertIn("2.5", (self.folder / "report.html").read_text(encoding="utf-8"))

    def test_a_wrong_file_of_deviations_is_refused_at_its_line(self) -> None:
        (self.folder / "wrong.json").write_text('{ "deviations": [\n  { "case": "8.4" } ] }\n', encoding="utf-8")
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --deviations wrong.json")
        self.assertEqual(result.returncode, 2)
        self.assertIn("wrong.json:2:3: error: missing member reason\n", result.stderr)

    def test_a_deviation_that_does_not_happen_is_an_error(self) -> None:
        (self.folder / "unused.json").write_text('{"deviations": [{"case": "2.1", "reason": "x"}]}', encoding="utf-8")
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 2.1 --deviations unused.json --quiet")
        self.assertEqual(result.returncode, 1)
        self.assertIn("unused deviation: unused.json:1: case 2.1 passed: x\n", result.stdout)

    def test_a_named_options_file_replaces_the_one_beside_the_eds(self) -> None:
        (self.folder / "other.json").write_text('{"pdo": {"inhibit_time_unit": 0}}', encoding="utf-8")
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 1.0 --options other.json")
        self.assertEqual(result.returncode, 1)
        self.assertIn("other.json:1:", result.stdout)
        self.assertRegex(result.stdout, "repeat with +edsc conform .* --options other.json --only 1.0")

    def test_a_case_that_does_not_run_names_all_options_that_it_needs(self) -> None:
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 3.6 --only 3.4 --only 8.2")
        self.assertIn("(needs --level communication and --outputs)", result.stdout)
        self.assertIn("(needs --level communication and --store)", result.stdout)
        self.assertIn("(needs --level communication)", result.stdout)
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 5.108")
        self.assertIn("(needs --level communication, --store and --outputs)", result.stdout)

    def test_a_stimulus_that_changes_nothing_and_one_that_fails(self) -> None:
        command = f"edsc conform {ADDRESS} 5 eds/rk5c.eds --level communication --only 3.4"
        without = self.run_line(command).stdout
        self.assertIn("use --stimulus with a command that changes one", without)
        ran = self.run_line(command + " --stimulus 3.4=true").stdout
        self.assertRegex(ran, r"the command of --stimulus ran, 6[0-9A-F]{3}h:[0-9A-F]{2}.* did not change")
        self.assertNotIn("use --stimulus", ran)
        failed = self.run_line(command + " --stimulus 3.4=false").stdout
        self.assertIn("; the command of --stimulus failed", failed)

    def test_a_failure_shows_the_frames_that_it_names(self) -> None:
        """The request and the response of 6501h:00, an upload (CiA 301, 7.2.4.3.6), are marked."""
        sheet = self.folder / "eds/rk5c.eds"
        text = sheet.read_text(encoding="utf-8")
        begin = text.index("[6501]")
        section = text[begin:text.index("[", begin + 1)]
        wrong = section.replace("=100000", "=200000").replace("AccessType=ro", "AccessType=const")
        sheet.write_text(text.replace(section, wrong), encoding="utf-8")
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 4.8 --json report.json")
        self.assertRegex(result.stdout, r"> +[0-9.]+ TX 605 40 01 65 00 .*\n +> +[0-9.]+ RX 585 4[23] 01 65 00 ")
        case = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))["cases"][0]
        named = [case["frames"][position] for position in case["failed_frames"]]
        self.assertEqual([(frame["can_id"], frame["data"][2:8]) for frame in named], [(0x605, "016500"), (0x585, "016500")])

    def test_a_missing_options_file_is_wrong_usage(self) -> None:
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --options missing.json")
        self.assertEqual(result.returncode, 2)
        self.assertIn("missing.json", result.stderr)

    def test_the_command_of_a_failure_repeats_it(self) -> None:
        first = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --level all --only 8.4")
        self.assertEqual(first.returncode, 1)
        command = re.search(r"repeat with +(edsc conform .*)", first.stdout)[1]
        again = self.run_line(command)
        self.assertEqual(again.returncode, 1)
        self.assertIn("8.4    failed", again.stdout)

    def test_values_have_their_unit(self) -> None:
        """The measuring step of the device is 100000, in steps of 0.001 µm; the EDS states twice of it."""
        sheet = self.folder / "eds/rk5c.eds"
        text = sheet.read_text(encoding="utf-8")
        begin = text.index("[6501]")
        section = text[begin:text.index("[", begin + 1)]
        wrong = section.replace("=100000", "=200000").replace("AccessType=ro", "AccessType=const")
        sheet.write_text(text.replace(section, wrong), encoding="utf-8")
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 4.8 --json report.json")
        self.assertEqual(result.returncode, 1)
        self.assertIn("6501h:00 Measuring step: 100 um instead of 200 um", result.stdout)
        self.assertIn("100 um instead of 200 um", (self.folder / "report.json").read_text(encoding="utf-8"))

    def test_a_case_that_does_not_exist_is_wrong_usage(self) -> None:
        result = self.run_line(f"edsc conform {ADDRESS} 5 eds/rk5c.eds --only 33.*")
        self.assertEqual(result.returncode, 2)
        self.assertIn("unknown case", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
