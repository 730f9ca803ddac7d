#!/usr/bin/env python3
"""edsc accept with live nodes: each planted difference has its mark, the commands of docs/accept.md do what the page says, and
the reports conform to their schemas.

    accept_test.py SOURCE_DIR EDSC RK5C [unittest arguments]

RK5C is the program of the reference device. The blocks of the document that name this script are run in order; the lines of
blocks without a language must be in the output of the commands before them.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import jsonschema

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
RK5C = Path(sys.argv[3]).resolve()
SLAVE = SOURCE_DIR / "tests/bus/accept/planted_slave.py"
sys.path[:0] = [str(SLAVE.parent), str(SOURCE_DIR / "tests/support")]
from document_commands import run_document  # noqa: E402
from planted_slave import GOOD, PLANTED, SILENT, eds_of  # noqa: E402

ADDRESS = "socketcand:127.0.0.1:29536/vcan0"  # in the document
TIMEOUT_MS = 60_000  # for an answer that must be received, even on a busy machine
SILENCE_MS = 3_000  # where an answer is not received
SCHEMAS = SOURCE_DIR / "docs/schema"


def schema(name: str) -> dict:
    return json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))


def definition(name: str, part: str) -> dict:
    return {"$ref": f"#/$defs/{part}", "$defs": schema(name)["$defs"]}


def without_foreign(node: object) -> object:
    """Without what refers to the schemas of `edsc check` and `edsc conform`, which `validate` uses one by one."""
    if isinstance(node, dict):
        foreign = node.get("$ref", "").startswith("urn:") if isinstance(node.get("$ref"), str) else False
        return {} if foreign else {name: without_foreign(value) for name, value in node.items()}
    return [without_foreign(value) for value in node] if isinstance(node, list) else node


def sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def validate(report: dict) -> None:
    jsonschema.Draft202012Validator(without_foreign(schema("accept"))).validate(report)
    jsonschema.Draft202012Validator(schema("conform")).validate(report["conform"])
    for finding in report["check"]["findings"]:
        jsonschema.Draft202012Validator(definition("check", "finding")).validate(finding)
    for difference in report["comparison"]["differences"]:
        for frame in difference["frames"]:
            jsonschema.Draft202012Validator(definition("conform", "frame")).validate(frame)


class Accept(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-accept-"))
        self.addCleanup(shutil.rmtree, self.folder)
        bus = self.start(EDSC, "bus", "--listen", "127.0.0.1:0")
        self.address = bus.stdout.readline().strip()

    def start(self, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen([*map(str, arguments)], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT)

        def end() -> None:
            process.kill()
            process.communicate()

        self.addCleanup(end)
        return process

    def start_rk5c(self) -> None:
        shutil.copytree(SOURCE_DIR / "eds", self.folder / "eds")
        node = self.start(RK5C, self.address, "--node-id", "5")
        while "pre-operational" not in (line := node.stdout.readline()):
            self.assertTrue(line, "the node has ended")

    def start_slave(self, *kind: str) -> None:
        (self.folder / "planted.eds").write_text(eds_of(GOOD if kind else PLANTED), encoding="utf-8")
        slave = self.start(sys.executable, SLAVE, self.address, 5, *kind)
        self.assertEqual(slave.stdout.readline(), "started\n")

    def accept(self, *options: object, timeout_ms: int = TIMEOUT_MS) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, "accept", self.address, "5", "planted.eds", "--timeout", f"{timeout_ms}ms", *map(str, options)],
                              cwd=self.folder, capture_output=True, text=True, timeout=1200)

    def report(self) -> dict:
        report = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))
        validate(report)
        return report

    def suites(self) -> ElementTree.Element:
        suites = ElementTree.parse(self.folder / "report.xml").getroot()
        tests = suites.findall("testsuite/testcase")
        self.assertEqual(len(tests), int(suites.get("tests")))
        for name in ("failure", "skipped"):
            found = [test for test in tests if test.find(name) is not None]
            self.assertEqual(len(found), int(suites.get("failures" if name == "failure" else name)), name)
        return suites

    def test_an_overlay_has_what_the_eds_has_wrong(self) -> None:
        self.start_slave()
        first = self.accept("--json", "before.json", "--only", "1.0", timeout_ms=SILENCE_MS)
        self.assertTrue((self.folder / "before.json").is_file(), first.stdout + first.stderr)
        before = json.loads((self.folder / "before.json").read_text(encoding="utf-8"))["comparison"]["differences"]
        corrections = [one for difference in before if difference["mark"] == "eds_wrong" for one in difference["corrections"]]
        self.assertGreaterEqual(len(corrections), 5)
        made = subprocess.run([EDSC, "overlay", "from-bus", self.address, "5", "planted.eds", "-o", "planted.overlay",
                               "--timeout", f"{SILENCE_MS}ms"], cwd=self.folder, capture_output=True, text=True, timeout=1200)
        self.assertEqual(made.returncode, 0, made.stdout + made.stderr)
        text = (self.folder / "planted.overlay").read_text(encoding="utf-8")
        self.assertIn("Base=planted.eds\n", text)
        for one in corrections:
            self.assertIn(f"[{one['section']}]\n", text)
            self.assertRegex(text, rf"; .*\(605#40[0-9A-F]{{14}}( [0-9A-F]{{3}}#[0-9A-F]*)*( \.\.\.)?\)\n(?:[^;\[].*\n)*"
                                   rf"{re.escape(one['key'])}=.*{re.escape(one['new'])}\n")
        (self.folder / "planted.eds").rename(self.folder / "base.eds")
        overlay = text.replace("Base=planted.eds", "Base=base.eds")
        (self.folder / "planted.eds").write_text(overlay, encoding="utf-8")
        self.accept("--json", "report.json", "--only", "1.0", timeout_ms=SILENCE_MS)
        left = [one for one in self.report()["comparison"]["differences"] if one["mark"] == "eds_wrong"]
        self.assertEqual(left, [])

    def test_each_planted_difference_has_its_mark(self) -> None:
        self.start_slave()
        result = self.accept("--html", "report.html", "--json", "report.json", "--junit", "report.xml", "--only", "2.1", "--title",
                             "A <title>", "--operator", "Ada", "--place", "Hall", "--log", "frames.log", timeout_ms=SILENCE_MS)
        self.assertEqual(result.returncode, 1, result.stderr)
        report = self.report()
        self.assertFalse(report["accepted"])
        differences = report["comparison"]["differences"]
        found = [f"{one['index']} {one['kind']} {one['mark']} {one['evidence']}" for one in differences]
        self.assertEqual(found, sorted(line for row in PLANTED for line in row.expected))
        marks = {(line.split()[1], line.split()[2]) for line in found}
        for kind in ("object_missing", "sub_index_missing", "not_in_eds", "length", "access", "value", "limit"):
            self.assertEqual({mark for of, mark in marks if of == kind}, {"eds_wrong", "device_wrong", "undecided"}, kind)
        self.check_corrections(differences)
        self.check_log(report)
        self.check_frames(differences)
        self.check_values(report["comparison"]["entries"])
        self.assertEqual((report["title"], report["operator"], report["place"]), ("A <title>", "Ada", "Hall"))
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        for text in ("not accepted", "A &lt;title&gt;", "Ada", "Hall", "device wrong", report["eds"]["sha256"], report["edsc"]):
            self.assertIn(text, page)
        dictionary = self.suites().find("testsuite[@name='dictionary']")
        failed = {test.get("name")[:5] for test in dictionary if test.find("failure") is not None}
        self.assertEqual(failed, {f"{row.index:04X}h" for row in PLANTED if row.expected})

    def check_corrections(self, differences: list[dict]) -> None:
        found = {f"{row['section']} {row['key']}": (row["old"], row["new"]) for one in differences for row in one["corrections"]}
        for row in PLANTED:
            for key, value in row.corrections.items():
                self.assertEqual(found.get(key), value, key)
        for one in differences:
            if one["mark"] == "device_wrong":
                self.assertEqual(one["corrections"], [])
            if one["mark"] == "eds_wrong":
                self.assertNotEqual(one["corrections"], [])

    def check_log(self, report: dict) -> None:
        """The log has each frame of the comparison and of the cases, with its time, in the order of the bus."""
        lines = re.findall(r"\((\d+)\.(\d{6})\) \S+ ([0-9A-F]{3})#([0-9A-F]*)", (self.folder / "frames.log").read_text(encoding="utf-8"))
        log = [(int(seconds) * 1_000_000 + int(micro), int(can_id, 16), data) for seconds, micro, can_id, data in lines]
        self.assertEqual([time for time, _, _ in log], sorted(time for time, _, _ in log))
        of_differences = [frame for one in report["comparison"]["differences"] for frame in one["frames"]]
        of_cases = [frame for case in report["conform"]["cases"] for frame in case["frames"]]
        for frame in of_differences + of_cases:
            self.assertIn((frame["at_us"], frame["can_id"], frame["data"]), log)
        self.assertLess(max(frame["at_us"] for frame in of_differences), min(frame["at_us"] for frame in of_cases))

    def check_frames(self, differences: list[dict]) -> None:
        """The request and the response of each difference are those of the entry."""
        values = {entry: value for row in PLANTED for entry, value in row.values.items()}
        for one in differences:
            entry = (int(one["index"][:4], 16), int(one["index"][6:], 16))
            multiplexer = entry[0].to_bytes(2, "little").hex().upper() + f"{entry[1]:02X}"
            request = one["frames"][0]
            self.assertEqual((request["can_id"], request["data"][:8], request["sent"]), (0x605, "40" + multiplexer, True))
            if values.get(entry) == SILENT:
                self.assertNotIn(0x585, [frame["can_id"] for frame in one["frames"]])
                continue
            response = one["frames"][1]
            self.assertEqual((response["can_id"], response["data"][2:8], response["sent"]), (0x585, multiplexer, False))
            value = values.get(entry)
            if isinstance(value, bytes) and len(value) <= 4:
                self.assertEqual(response["data"][8:8 + 2 * len(value)], value.hex().upper())
            else:
                self.assertEqual(response["data"][:2], "80")

    def check_values(self, entries: list[dict]) -> None:
        """A stored or live value is not a difference."""
        for entry in entries:
            if entry["index"][:4] in ("2020", "2021"):
                self.assertEqual((entry["exists"], entry["value"]), ("same", "may_differ"))
        self.assertIn("differs from its default value, as stored or live values may",
                      (self.folder / "report.html").read_text(encoding="utf-8"))

    def test_a_good_device_is_accepted(self) -> None:
        self.start_slave("good")
        result = self.accept("--json", "report.json", "--junit", "report.xml", "--only", "2.1", "--only", "4.*")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        cases = json.loads((self.folder / "report.json").read_text(encoding="utf-8"))["conform"]["cases"]
        ran = len([case for case in cases if case["verdict"] in ("passed", "failed", "deviates", "inconclusive")])
        listed = subprocess.run([EDSC, "conform", "--list"], capture_output=True, text=True, check=True).stdout
        all_cases = len(re.findall(r"^  \d+\.\d+ ", listed, re.MULTILINE))
        self.assertTrue(result.stdout.endswith(f"\naccepted (level read: {ran} of {all_cases} cases run)\n"), result.stdout)
        report = self.report()
        self.assertEqual((report["accepted"], report["objections"], report["comparison"]["differences"]), (True, [], []))
        self.assertTrue(all(entry["exists"] == "same" for entry in report["comparison"]["entries"]))
        self.assertFalse(any(number["differs"] for number in report["identity"]))
        self.assertEqual(self.suites().get("failures"), "0")

    def test_a_failed_case_is_not_accepted(self) -> None:
        """The slave responds to a missing sub-index as CiA 301 requires, and does not have 1001h."""
        self.start_slave()
        result = self.accept("--json", "report.json", "--only", "4.1", "--quiet", timeout_ms=SILENCE_MS)
        self.assertEqual(result.returncode, 1)
        self.assertTrue(any("conformance test failed" in text for text in self.report()["objections"]))

    def test_declared_differences_are_accepted(self) -> None:
        rows = [{"case": "4.2", "object": "1018h:02", "reason": "an older EDS", "source": "manual, page 3"}]
        (self.folder / "deviations.json").write_text(json.dumps({"deviations": rows}), encoding="utf-8")
        self.start_slave("good")
        sheet = self.folder / "planted.eds"
        sheet.write_text(sheet.read_text(encoding="utf-8").replace("DefaultValue=0x42\n", "DefaultValue=0x41\n"), encoding="utf-8")
        options = ("--json", "report.json", "--junit", "report.xml", "--only", "4.2")
        self.assertEqual(self.accept(*options).returncode, 1)
        result = self.accept(*options, "--deviations", "deviations.json")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        report = self.report()
        reason = "an older EDS (manual, page 3)"
        self.assertEqual(report["comparison"]["differences"][0]["deviation"], reason)
        self.assertEqual([row["deviation"] for row in report["identity"] if row["differs"]], [reason])
        self.assertEqual(report["conform"]["identity"]["deviation"], reason)
        self.assertEqual(report["deviations"]["sha256"], sha256(self.folder / "deviations.json"))
        self.assertEqual(report["eds"]["sha256"], sha256(sheet))
        self.assertIsNone(report["options"])
        suites = self.suites()
        self.assertEqual(suites.get("failures"), "0")
        number = suites.find("testsuite[@name='identity']/testcase[@name='product code']/skipped")
        self.assertIn(reason, number.get("message"))

    def test_another_product_is_only_written_with_force(self) -> None:
        """Level communication and case 4.3 write: SDO requests with the command specifier 1 (CiA 301, 7.2.4.3.3)."""
        self.start_slave("good")
        sheet = self.folder / "planted.eds"
        sheet.write_text(sheet.read_text(encoding="utf-8").replace("DefaultValue=0x42\n", "DefaultValue=0x41\n"), encoding="utf-8")
        options = ("--only", "4.3", "--level", "communication", "--json", "report.json", "--log", "frames.log")

        def writes() -> int:
            log = (self.folder / "frames.log").read_text(encoding="utf-8")
            return len(re.findall(r" 605#[23][0-9A-F]{15}$", log, re.MULTILINE))

        result = self.accept(*options)
        self.assertEqual(result.returncode, 1, result.stderr)
        reason = self.report()["conform"]["ended_early"]
        self.assertIn("node 5 is not the device of planted.eds: product code is 00000042h, expected 00000041h; nothing was written",
                      reason)
        self.assertIn("--force", reason)
        self.assertEqual((self.report()["conform"]["cases"], writes()), ([], 0))
        self.assertIn(f"conformance test failed: the run ended early: {reason}", result.stdout)
        self.accept(*options, "--force")
        self.assertEqual([case["id"] for case in self.report()["conform"]["cases"]], ["4.3"])
        self.assertIn(" --force ", self.report()["conform"]["cases"][0]["repeat"])
        self.assertGreater(writes(), 0)
        self.accept("--only", "4.2", "--json", "report.json")
        self.assertIsNone(self.report()["conform"]["ended_early"], "level read only reads")
        conform = subprocess.run([EDSC, "conform", self.address, "5", "planted.eds", "--store", "--only", "2.1"], cwd=self.folder,
                                 capture_output=True, text=True)
        self.assertEqual(conform.returncode, 1)
        self.assertIn("failed: the run ended early: node 5 is not the device of planted.eds", conform.stdout)

    def test_an_interruption_ends_with_130_and_a_report(self) -> None:
        self.start_slave()
        process = subprocess.Popen([EDSC, "accept", self.address, "5", "planted.eds", "--timeout", f"{TIMEOUT_MS}ms", "--json",
                                    "report.json"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(2)  # it waits for the response of 2008h
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=600)
        self.assertEqual(process.returncode, 130)
        report = self.report()
        self.assertTrue(report["comparison"]["interrupted"] or report["conform"]["interrupted"])
        self.assertIn("conformance test failed: the run was interrupted; no case ran", report["objections"])
        self.assertFalse(report["accepted"])

    def test_a_device_that_does_not_respond_is_not_accepted(self) -> None:
        (self.folder / "planted.eds").write_text(eds_of(GOOD), encoding="utf-8")
        result = self.accept("--json", "report.json", timeout_ms=100)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(self.report()["comparison"]["ended_early"], "node 5 does not respond")

    def test_wrong_usage(self) -> None:
        (self.folder / "planted.eds").write_text(eds_of(GOOD), encoding="utf-8")
        for options in (("--level", "much"), ("--only", "99.1"), ("--deviations", "missing.json"), ("--html", "planted.eds")):
            if options[0] == "--html":
                self.start_slave("good")
            self.assertEqual(self.accept(*options).returncode, 2, options)
        result = subprocess.run([EDSC, "accept", "nonsense:", "5", "planted.eds"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)

    def test_the_document(self) -> None:
        self.start_rk5c()
        shutil.copytree(SOURCE_DIR / "examples/ci", self.folder / "examples/ci")
        run_document(self, SOURCE_DIR / "docs/accept.md", "tests/cli/live/accept_test.py", self.run_line, 5)
        self.report()
        self.suites()
        self.assertEqual({path.name for path in (self.folder / "reports").iterdir()},
                         {"accept.html", "accept.json", "accept.log", "accept.xml"})

    def test_the_script_for_ci_has_an_exit_code_for_each_result(self) -> None:
        """Not accepted is 1, a bus that does not exist is 2 without a report; docs/accept.md has the others."""
        self.start_slave("good")
        sheet = self.folder / "planted.eds"
        sheet.write_text(sheet.read_text(encoding="utf-8").replace("DefaultValue=0x42\n", "DefaultValue=0x41\n"), encoding="utf-8")
        script = f"{SOURCE_DIR}/examples/ci/accept.sh reports"
        wrong = self.run_line(f"{script} {self.address} 5 planted.eds --only 4.2 --timeout {TIMEOUT_MS}ms")
        self.assertEqual(wrong.returncode, 1, wrong.stdout + wrong.stderr)
        self.assertTrue((self.folder / "reports/accept.xml").is_file())
        no_bus = self.run_line(f"{script} nonsense: 5 planted.eds")
        self.assertEqual(no_bus.returncode, 2)
        self.assertFalse((self.folder / "reports/accept.json").is_file())

    def run_line(self, line: str) -> subprocess.CompletedProcess[str]:
        command = re.sub(rf"(edsc accept {ADDRESS} \S+ \S+)", rf"\1 --timeout {TIMEOUT_MS}", line).replace(ADDRESS, self.address)
        environment = {**os.environ, "PATH": f"{EDSC.parent}{os.pathsep}{os.environ['PATH']}"}
        return subprocess.run(["bash", "-c", command], cwd=self.folder, env=environment, capture_output=True, text=True)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], verbosity=2)
