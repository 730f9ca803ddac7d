#!/usr/bin/env python3
"""The commands of docs/tutorial.md in their order.

    tutorial_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import re
import shutil
import sys
import unittest

from document_commands import DocumentTest

WITHOUT_BOARD = "" if shutil.which("arm-none-eabi-g++") and shutil.which("qemu-system-arm") else (
    "SKIPPED: arm-none-eabi-g++ or qemu-system-arm is not installed")
SERIAL_LINE = "/dev/pts/3"  # in the document


class Tutorial(DocumentTest):
    def run_command(self, line: str) -> str:
        if SERIAL_LINE in line:
            (opened,) = re.findall(r"/dev/pts/\d+", "\n".join(self.programs["qemu-system-arm"].lines))
            line = line.replace(SERIAL_LINE, opened)
        return super().run_command(line)

    @unittest.skipIf(WITHOUT_BOARD, WITHOUT_BOARD)
    def test_the_commands_in_their_order(self) -> None:
        printed = self.run_document("docs/tutorial.md")
        outputs = list(printed.values())
        self.assertIn("100% tests passed", "".join(outputs))
        reads = [output for command, output in printed.items() if command.startswith("edsc read")]
        self.assertEqual(reads, ["2001h:00 Pressure = 420 mbar\n", "2001h:00 Pressure = 250 mbar\n"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
