#!/usr/bin/env python3
"""The commands of docs/pdos.md and of docs/how-to/{coming-from-python-canopen,lss,storage}.md in their order.

    pages_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import json
import sys
import unittest

from document_commands import DocumentTest, Program


class Pages(DocumentTest):
    def wait_until_ready(self, name: str, program: Program) -> None:
        if name != "rk5c":
            return super().wait_until_ready(name, program)
        program.wait_for("state initialisation, node-ID none")  # it waits for LSS

    def test_python_canopen(self) -> None:
        printed = self.run_document("docs/how-to/coming-from-python-canopen.md")
        outputs = list(printed.values())
        self.assertIn('1008h:00 Manufacturer device name = "TC1-8/230"\n', outputs)
        (read,) = [json.loads(output) for output in outputs if output.startswith("{")]
        self.assertEqual(read["entries"][0]["value"], 500)
        self.assertIn(" operational ", outputs[-1])

    def test_mapping(self) -> None:
        printed = self.run_commands("docs/pdos.md")
        self.assertIn("60640020h", printed[-1][1])
        self.assertIn("60410010h", printed[-1][1])

    def test_storage(self) -> None:
        printed = self.run_commands("docs/how-to/storage.md")
        reads = [output for command, output in printed if command.startswith("edsc read")]
        self.assertEqual(reads, ["1017h:00 Producer heartbeat time = 250 ms\n",
                                 "1017h:00 Producer heartbeat time = 0 ms\n"])

    def test_lss(self) -> None:
        printed = self.run_document("docs/how-to/lss.md")
        self.assertIn("node-ID 7", printed["edsc lss $BUS inquire"])
        self.assertEqual(list(printed.values())[-1], "1018h:04 Identity object, Serial number = 00000001h\n")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
