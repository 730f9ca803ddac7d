#!/usr/bin/env python3
"""The commands of docs/networks.md, "Without the devices", in their order.

    virtual_plant_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import re
import sys
import unittest
from xml.etree import ElementTree

from document_commands import DocumentTest, Program


class VirtualPlant(DocumentTest):
    def start(self, command: str) -> str:
        name = "network run" if "network run" in command else "bus"
        self.programs[name] = Program(command, self.folder, self.variables)
        self.wait_until_ready(name, self.programs[name])
        return ""

    def wait_until_ready(self, name: str, program: Program) -> None:
        if name == "bus":
            return program.wait_for("socketcand:.*")
        program.wait_for(r"http://127\.0\.0\.1:\d+/\?token=.*")
        for node in ("outputs (1)", "inputs (2)", "encoder (5)"):
            program.wait_for(f"node {re.escape(node)} .*: simulated")

    def test_the_commands_in_their_order(self) -> None:
        printed = "".join(self.run_document("docs/networks.md").values())
        self.assertIn("3 of 3 nodes configured, started", printed)
        page = ElementTree.parse(self.folder / "plant/line.svg").getroot()
        texts = " ".join(text for element in page.iter() for text in element.itertext())
        self.assertRegex(texts, r"node 1 outputs Write output 8-bit, .* 6200h:01: [5-8] values, 1 to 15")
        self.assertRegex(texts, r"node 5 encoder .* 6020h:01: \d{2,} values")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
