#!/usr/bin/env python3
"""The HTML of edsc audit in headless Chromium: of a log with findings, of names with markup, and of one without findings.

    audit_page_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

npm installs puppeteer-core and axe-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from document_case import DocumentCase, main, sheet, var

HOSTILE = "<script>alert(1)</script>"
# A node that sends its heartbeat too late, an EMCY of unknown bits, and an SDO request without an answer (CiA 301).
WITH_FINDINGS = """(0.000000) can0 705#00
(0.100000) can0 705#7F
(0.200000) can0 705#7F
(0.900000) can0 705#7F
(1.000000) can0 085#1081000000000000
(1.100000) can0 605#4000100000000000
(9.000000) can0 705#7F
"""
WITHOUT = "".join(f"({at / 10:.6f}) can0 705#{'00' if at == 0 else '7F'}\n" for at in range(20))


class AuditPage(DocumentCase):
    def audit(self, name: str, log: str, exit_code: int) -> Path:
        device = self.write("device.eds", sheet(
            var(0x1000, "Device type", DataType="7", AccessType="ro", DefaultValue="0"),
            var(0x1001, "Error register", DataType="5", AccessType="ro"),
            var(0x1017, "Producer heartbeat time", DefaultValue="100"), product=HOSTILE))
        page = self.folder / f"{name}.html"
        self.edsc("audit", self.write(f"{name}.log", log), "--node", f"5={device}", "--format", "html", "-o", page,
                  exit_code=exit_code)
        return page

    def test_the_pages_are_clean_in_light_and_dark(self) -> None:
        pages = [self.audit("findings", WITH_FINDINGS, 1), self.audit("clean", WITHOUT, 0)]
        self.assert_clean(self.browse("audit", *pages))
        found = self.browse("texts", pages[0], "#audit tbody td:last-child", "script", "h2 small")
        self.assertIn("node-lost", found["#audit tbody td:last-child"])
        self.assertEqual(found["script"], [])
        self.assertEqual(self.browse("texts", pages[1], "#audit tbody td")["#audit tbody td"], [])

    def test_tidy_reads_the_html_without_errors(self) -> None:
        if shutil.which("tidy") is None:
            self.skipTest("tidy is not installed")
        for page in (self.audit("findings", WITH_FINDINGS, 1), self.audit("clean", WITHOUT, 0)):
            tidy = subprocess.run(["tidy", "-q", "-e", "--drop-empty-elements", "no", page], capture_output=True, text=True)
            self.assertEqual((tidy.stderr, tidy.returncode), ("", 0), page.name)


if __name__ == "__main__":
    main()
