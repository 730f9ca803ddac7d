#!/usr/bin/env python3
"""The reports of edsc conform about a device that fails cases: the HTML in headless Chromium, the JUnit XML by xmllint.

    conform_page_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

npm installs puppeteer-core and axe-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

from document_case import EDSC, SOURCE_DIR, DocumentCase, main

HERE = SOURCE_DIR / "tests/bus/conform"
sys.path.append(str(HERE))
from bench import NODE_ID, Bench  # noqa: E402

HOSTILE = "<script>alert(1)</script>"
# Failures (abort code, length), a case without its stimulus, and cases that do not apply.
CASES = ("1.0", "2.5", "2.6", "2.8", "3.4", "4.1")


class ConformPage(DocumentCase):
    def setUp(self) -> None:
        super().setUp()
        self.page, self.junit = self.folder / "report.html", self.folder / "report.xml"
        sheet = self.write("device.eds", (HERE / "foreign_slave.eds").read_text(encoding="utf-8").replace(
            "VendorName=edsc", f"VendorName={HOSTILE}", 1))
        bench = Bench(EDSC, self.folder / "bench")
        self.addCleanup(bench.close)
        bench.start_node([sys.executable, HERE / "foreign_slave.py"], [NODE_ID, "abort-code", "length"], "started")
        bench.conform(sheet, self.folder / "report.json", "--html", self.page, "--junit", self.junit, "--title", HOSTILE,
                      "--operator", "A. Tester", "--place", "hall 2", *(f"--only={case}" for case in CASES))

    def test_the_page_is_clean_in_light_and_dark_and_shows_causes_first(self) -> None:
        self.assert_clean(self.browse("audit-expanded", self.page))
        found = self.browse("texts", self.page, "h1", "h2", "ul.causes li", "dd")
        self.assertEqual(found["h1"], [HOSTILE])
        self.assertRegex(found["h2"][0], r"^[0-9]+ failed cases?, [0-9]+ causes?$")
        self.assertTrue(any("2.5" in text for text in found["ul.causes li"]), found["ul.causes li"])
        for text in ("A. Tester", "hall 2"):
            self.assertIn(text, found["dd"])

    def test_tidy_reads_the_html_without_errors(self) -> None:
        if shutil.which("tidy") is None:
            self.skipTest("tidy is not installed")
        tidy = subprocess.run(["tidy", "-q", "-e", "--drop-empty-elements", "no", self.page], capture_output=True, text=True)
        self.assertEqual((tidy.stderr, tidy.returncode), ("", 0))

    def test_xmllint_validates_the_junit_report(self) -> None:
        if shutil.which("xmllint") is None:
            self.skipTest("xmllint is not installed")

        def validate(path: Path) -> subprocess.CompletedProcess[str]:
            return subprocess.run(["xmllint", "--noout", "--schema", HERE / "junit.xsd", path], capture_output=True, text=True)

        result = validate(self.junit)
        self.assertEqual(result.returncode, 0, result.stderr)
        text = self.junit.read_text(encoding="utf-8")
        self.assertIn("<failure", text)
        self.assertIn("<skipped", text)
        wrong = self.write("wrong.xml", text.replace('timestamp="2', 'timestamp="on 2', 1))
        self.assertNotEqual(validate(wrong).returncode, 0)


if __name__ == "__main__":
    main()
