"""What the tests of edsc document share: edsc, a browser, and EDS files that they write.

    *_page_test.py SOURCE_DIR EDSC WORK_DIR [--sample] [unittest arguments]

--sample: axe-core reads a quarter of the pages of devices, and one of a network.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
WORK = Path(sys.argv[3]).resolve()
SAMPLE = "--sample" in sys.argv[4:]
sys.path[:0] = [str(SOURCE_DIR / "tests/support"), str(SOURCE_DIR / "tests/masters")]
from browser import CHROMIUM, install_browser  # noqa: E402

DEVICES = sorted((SOURCE_DIR / "eds").glob("*.eds"))

HEAD = """[FileInfo]
FileName=test.eds
FileVersion=1
FileRevision=1
EDSVersion=4.0
[DeviceInfo]
VendorName={vendor}
ProductName={product}
BaudRate_125=1
SimpleBootUpSlave=1
Granularity=8
[MandatoryObjects]
SupportedObjects=0
"""


def sampled(paths: list[Path]) -> list[Path]:
    """All of them, or with --sample each fourth."""
    return paths[::4] if SAMPLE else paths


def var(index: int, name: str, **keys: str) -> str:
    """The section of a VAR: UNSIGNED16, rw, unless the keys state something else."""
    values = {"ParameterName": name, "ObjectType": "7", "DataType": "6", "AccessType": "rw", "PDOMapping": "0"} | keys
    return f"[{index:04X}]\n" + "".join(f"{key}={value}\n" for key, value in values.items())


def sheet(*objects: str, vendor: str = "Vendor", product: str = "Product") -> str:
    return HEAD.format(vendor=vendor, product=product) + "".join(objects)


class DocumentCase(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls) -> None:
        install_browser(SOURCE_DIR, WORK)

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-document-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def edsc(self, *arguments: object, exit_code: int = 0) -> subprocess.CompletedProcess[str]:
        result = subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result

    def write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def document(self, path: Path, *arguments: object, output: str = "") -> Path:
        page = self.folder / (output or path.stem + ".html")
        self.edsc("document", path, "-o", page, *arguments)
        return page

    def node(self, script: str, *arguments: object) -> object:
        result = subprocess.run(["node", script, *map(str, arguments)], cwd=WORK, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def browse(self, command: str, *arguments: object) -> dict:
        return self.node("pages.mjs", CHROMIUM, command, *arguments)

    def assert_clean(self, found: dict) -> None:
        for page, one in found.items():
            self.assertEqual(one, {"errors": [], "requests": [], "violations": []}, page)


def main() -> None:
    program = unittest.main(argv=[sys.argv[0], *(one for one in sys.argv[4:] if one != "--sample")], module="__main__", exit=False)
    if program.result.testsRun == 0 and program.result.skipped:
        sys.exit(77)
    sys.exit(not program.result.wasSuccessful())
