#!/usr/bin/env python3
"""edsc document with another version of the device, and of a DCF, in headless Chromium.

    against_page_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

npm installs puppeteer-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import subprocess

from document_case import DocumentCase, main, sheet, var

OLD = sheet(var(0x2000, "Speed"), var(0x2001, "Ramp"), var(0x2002, "Removed"), var(0x2003, "Same"))
NEW = sheet(var(0x2000, "Speed", AccessType="ro"), var(0x2001, "Ramp", DefaultValue="5"), var(0x2003, "Same"),
            var(0x2004, "Added"))


class AgainstPage(DocumentCase):
    def check_page(self, page: object, old_name: str) -> None:
        found = self.browse("texts", page, "#changes-title", "#changes tr.breaking td:first-child",
                            "#changes tr.compatible td:first-child", ".object.breaking summary code",
                            ".object.compatible summary code", "#changes a", "label.check")
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        self.assertIn(f"Changes since {old_name}", found["#changes-title"][0])
        # The access of 2000h is reduced and 2002h is gone; a master that writes them is broken.
        self.assertEqual(found["#changes tr.breaking td:first-child"], ["2000h:00", "2002h"])
        self.assertEqual(found[".object.breaking summary code"], ["2000h"])
        self.assertEqual(found[".object.compatible summary code"], ["2001h", "2004h"])
        self.assertEqual(found["#changes a"], ["2000h:00", "2001h:00", "2004h"])
        self.assertEqual(found["label.check"], [f"changed since {old_name}"])

    def test_changes_since_another_file(self) -> None:
        old, new = self.write("drive-1.0.eds", OLD), self.write("drive.eds", NEW)
        self.check_page(self.document(new, "--against", old, "--keep-going"), "drive-1.0.eds")

    def test_changes_since_a_git_revision(self) -> None:
        path = self.write("drive.eds", OLD)
        for words in (["init", "-q"], ["add", "drive.eds"],
                      ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "-m", "old"]):
            subprocess.run(["git", *words], cwd=self.folder, check=True)
        path.write_text(NEW)
        self.check_page(self.document(path, "--against", "git:HEAD", "--keep-going"), "git:HEAD")

    def test_the_filter_of_changed_objects(self) -> None:
        old, new = self.write("drive-1.0.eds", OLD), self.write("drive.eds", NEW)
        page = self.document(new, "--against", old, "--keep-going")
        self.assertEqual(self.browse("check", page, "#differs")["objects"], ["2000h", "2001h", "2004h"])

    def test_the_filter_of_values_that_are_not_the_default(self) -> None:
        dcf = sheet("[DeviceComissioning]\nNodeID=5\n", var(0x2000, "Speed", DefaultValue="10", ParameterValue="20"),
                    var(0x2001, "Ramp", DefaultValue="10", ParameterValue="10"), var(0x2002, "Limit", DefaultValue="10"))
        page = self.document(self.write("axis.dcf", dcf), "--keep-going")
        self.assertEqual(self.browse("check", page, "#changed")["objects"], ["2000h"])
        found = self.browse("texts", page, '[id="2000h"] tbody td:nth-child(6)', '[id="2000h"] tbody td:nth-child(7)')
        self.assertEqual(found['[id="2000h"] tbody td:nth-child(6)'], ["10"])
        self.assertEqual(found['[id="2000h"] tbody td:nth-child(7)'], ["20"])

    def test_a_missing_older_version_is_an_error(self) -> None:
        path = self.write("drive.eds", NEW)
        for older in ("missing.eds", "git:no-such-revision"):
            result = self.edsc("document", path, "-o", "page.html", "--against", older, "--keep-going", exit_code=2)
            self.assertNotEqual(result.stderr, "")
            self.assertFalse((self.folder / "page.html").exists())


if __name__ == "__main__":
    main()
