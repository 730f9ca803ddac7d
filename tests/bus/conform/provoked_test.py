#!/usr/bin/env python3
"""edsc audit checks the log of edsc conform: what the cases provoke on purpose is listed by case, and nothing else is found.

    provoked_test.py SOURCE_DIR EDSC EVERY_SERVICE

EVERY_SERVICE is a program of the device with every service in simulated time. A fault that is planted in the log is found.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from collections import defaultdict
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
PROGRAM = Path(sys.argv[3]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/every_service.eds"


class Provoked(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        result = subprocess.run([EDSC, "conform", f"simulated:{PROGRAM}@5", "5", SHEET, "--level", "all", "--quiet", "--log", "frames.log",
                                 "--json", "report.json"], cwd=cls.folder, capture_output=True, text=True, timeout=600, check=False)
        assert result.returncode == 0, result.stdout + result.stderr
        cls.log = (cls.folder / "frames.log").read_text().splitlines()
        cls.report = json.loads((cls.folder / "report.json").read_text())

    def run_audit(self, log: list[str], *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, "audit", "-", "--node", f"5={SHEET}", *arguments], input="\n".join(log) + "\n", cwd=self.folder,
                              capture_output=True, text=True, timeout=600, check=False)

    def audit(self, log: list[str]) -> dict:
        return json.loads(self.run_audit(log, "--conform", "report.json", "--format", "json").stdout)

    def began_us(self, case: str) -> int:
        return next(one["began_us"] for one in self.report["cases"] if one["id"] == case)

    def lines_from(self, case: str) -> range:
        """The places of the frames from the beginning of a case on."""
        at = next(at for at, line in enumerate(self.log) if float(line[1:].partition(")")[0]) * 1e6 > self.began_us(case))
        return range(at, len(self.log))

    def changed(self, at: int, old: str, new: str) -> list[str]:
        self.assertIn(old, self.log[at])
        return [*self.log[:at], self.log[at].replace(old, new), *self.log[at + 1:]]

    def test_nothing_is_found_that_no_case_provokes(self) -> None:
        audit = self.audit(self.log)
        self.assertEqual(audit["findings"], [])
        self.assertGreater(sum(one["count"] for one in audit["provoked"]), 1000)

    def test_each_finding_has_its_case(self) -> None:
        cases = defaultdict(list)
        for one in self.audit(self.log)["provoked"]:
            cases[one["rule"]].append(one["case"])
        aborts = cases.pop("sdo-abort")
        self.assertGreater(len(aborts), 40)
        declared = {rule: [one["id"] for one in self.report["cases"] if rule in one["provokes"]] for rule in cases}
        self.assertEqual(cases, declared | {"lss-refused": ["11.11", "11.13", "11.15"]}, "this device does not refuse node-ID 255")
        self.assertEqual(set(cases), {"can-id-unknown", "lss-mode", "lss-refused", "nmt-command", "nmt-reset", "node-unknown", "pdo-length",
                                      "sdo-command", "sdo-crc", "sdo-gives-up", "sdo-length", "sdo-sequence", "sdo-toggle", "sdo-unfinished"})

    def test_without_the_report_they_are_findings(self) -> None:
        result = self.run_audit(self.log, "--format", "json")
        audit = json.loads(result.stdout)
        self.assertEqual((result.returncode, audit["provoked"]), (1, []))
        self.assertGreater(audit["notes"], 1000)

    def test_a_planted_fault_is_found(self) -> None:
        def frames(case: str, text: str) -> list[int]:
            return [at for at in self.lines_from(case) if text in self.log[at]]

        heartbeat, tpdo, sync = frames("7.102", "705#7F")[5], frames("9.3", " 185#")[0], frames("6.2", " 080#")[5]
        for rule, log in (("nmt-state", self.changed(heartbeat, "#7F", "#05")),
                          ("pdo-length", self.changed(tpdo, self.log[tpdo][-2:], "")),
                          ("sync-period", self.log[:sync] + self.log[sync + 1:]),
                          ("heartbeat-late", self.log[:heartbeat] + self.log[heartbeat + 1:])):
            with self.subTest(rule):
                self.assertIn(rule, {one["rule"] for one in self.audit(log)["findings"]})

    def test_a_fault_that_another_case_provokes_is_found(self) -> None:
        """A wrong toggle bit is provoked by 2.17, but not by 2.16."""
        segment = next(at for at in self.lines_from("2.16") if " 605#60" in self.log[at]) + 1
        findings = self.audit(self.changed(segment, " 585#0", " 585#1"))["findings"]
        self.assertIn("sdo-toggle", {one["rule"] for one in findings})

    def test_text_and_page(self) -> None:
        text = self.run_audit(self.log, "--conform", "report.json")
        self.assertEqual(text.returncode, 0)
        self.assertIn("<stdin>: provoked by case 2.7: sdo-command; sdo-abort\n", text.stdout)
        self.assertRegex(text.stdout.splitlines()[-1], r"^<stdin>: \d+ frames of 2 nodes in [\d.]+ s: no findings$")
        self.assertIn("<li>by case 2.7: sdo-command; sdo-abort</li>", self.run_audit(self.log, "--conform", "report.json", "--format", "html").stdout)

    def test_a_file_that_is_not_a_report(self) -> None:
        for name, text in (("empty.json", ""), ("other.json", "{}")):
            (self.folder / name).write_text(text)
            result = self.run_audit(self.log, "--conform", name)
            self.assertEqual((result.returncode, result.stdout), (1, ""))
            self.assertIn(f'{name}: not a report of "edsc conform --json"', result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
