#!/usr/bin/env python3
"""The conformance test does not fail a device for what its EDS allows: a synchronous window, COB-IDs that cannot be written.

    edited_devices_test.py SOURCE_DIR EDSC DYNAMIC_DEVICE

The devices are fixtures of which some defaults or access rights differ, as nodes without a compiler.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FIXTURES = Path(sys.argv[1]).resolve() / "tests/fixtures"
EDSC, DYNAMIC = (Path(name).resolve() for name in sys.argv[2:4])


class EditedDevices(unittest.TestCase):
    def verdicts(self, sheet: str, section: str, key: str, value: str, *cases: str) -> dict[str, str]:
        """Of cases of a fixture with another value of a key in the sections whose names match."""
        text = (FIXTURES / sheet).read_text(encoding="latin-1")
        text, edited = re.subn(rf"(?ms)^(\[{section}\]\n(?:(?!\[).*?)?^{key}=)[^\n]*", rf"\g<1>{value}", text)
        self.assertGreater(edited, 0)
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            eds, device, report = folder / "device.eds", folder / "device", folder / "report.json"
            eds.write_text(text, encoding="latin-1")
            device.write_text(f'#!/bin/sh\nexec "{DYNAMIC}" "{eds}"\n')
            device.chmod(0o755)
            only = [argument for case in cases for argument in ("--only", case)]
            result = subprocess.run([EDSC, "conform", f"simulated:{device}@5", "5", eds, "--level", "all", "--quiet", "--json", report, *only],
                                    capture_output=True, text=True, timeout=300, check=False)
            self.assertIn(result.returncode, (0, 1), result.stderr)
            found = json.loads(report.read_text())["cases"]
        return {case["id"]: case["verdict"] for case in found if case["id"] in cases}

    def test_a_synchronous_window_ends_before_an_rpdo_is_sent(self) -> None:
        for window in ("0", "100", "10000"):
            with self.subTest(window):
                # 3.6 sends the SYNC with which the window begins.
                found = self.verdicts("every_service.eds", "1007", "DefaultValue", window, "3.6", "3.107")
                self.assertEqual(found, {"3.6": "passed", "3.107": "passed"})

    def test_an_inhibit_time_may_change_if_the_cob_id_cannot(self) -> None:
        self.assertEqual(self.verdicts("pdo_device.eds", "1800sub1", "AccessType", "rw", "3.110"), {"3.110": "passed"})
        found = self.verdicts("pdo_device.eds", "180[0-9A-F]sub1", "AccessType", "ro", "3.110")
        self.assertEqual(found, {"3.110": "not_applicable"})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
