#!/usr/bin/env python3
"""A device whose EDS is loaded at run time sends the same frames as the device that edsc generates from the same EDS.

    dynamic_devices_test.py SOURCE_DIR EDSC DYNAMIC_DEVICE GENERATED_DEVICES

The conformance test with all cases runs in simulated time against both, and their logs are compared, frame by frame and time by
time.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC, DYNAMIC, GENERATED = (Path(name).resolve() for name in sys.argv[2:5])

REFERENCE = ("can-2017c", "can-2024c", "can-2053c", "can-2057c", "cpc-tc1", "cpd", "ezd-1136", "rk5c")


class DynamicDevices(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def frames(self, name: str, address: str, eds: Path) -> list[str]:
        """The times and frames of a log, without the name of the bus."""
        log = self.folder / f"{name}.log"
        command = [EDSC, "conform", address, "5", eds, "--level", "all", "--store", "--quiet", "--log", log]
        result = subprocess.run(command, capture_output=True, text=True, timeout=900, check=False)
        self.assertIn(result.returncode, (0, 1), result.stdout + result.stderr)
        lines = (line.split() for line in log.read_text().splitlines())
        return [f"{time} {frame}" for time, _, frame in lines]

    def program(self, eds: Path) -> Path:
        """A program without arguments, as an address of edsc names it."""
        script = self.folder / "dynamic"
        script.write_text(f'#!/bin/sh\nexec "{DYNAMIC}" "{eds}"\n')
        script.chmod(0o755)
        return script

    def compare(self, device: str, eds: Path) -> None:
        generated = self.frames("generated", f"simulated:{GENERATED}@5,{device}", eds)
        dynamic = self.frames("dynamic", f"simulated:{self.program(eds)}@5", eds)
        self.assertGreater(len(generated), 2000)
        for place, (expected, got) in enumerate(zip(generated, dynamic)):
            self.assertEqual(got, expected, f"frame {place} of {device}; before it: {generated[max(place - 4, 0):place]}")
        self.assertEqual(len(dynamic), len(generated))

    def test_reference_devices(self) -> None:
        for name in REFERENCE:
            with self.subTest(name):
                self.compare(name.replace("-", "_"), SOURCE_DIR / f"eds/{name}.eds")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
