#!/usr/bin/env python3
"""The commands of docs/networks.md, "From three EDS files to a running network", in their order.

    first_network_test.py SOURCE_DIR BUILD_DIR [unittest arguments]
"""

from __future__ import annotations

import shutil
import signal
import sys
import unittest

from document_commands import DocumentTest, Program


class FirstNetwork(DocumentTest):
    def wait_until_ready(self, name: str, program: Program) -> None:
        if name != "line":
            return super().wait_until_ready(name, program)
        for node in ("outputs", "inputs", "encoder"):
            program.wait_for(f"{node}: booted")

    def test_the_commands_in_their_order(self) -> None:
        if shutil.which("ccache"):
            self.variables["CXX"] = "ccache c++"  # for the simulation
            del self.variables["CMAKE_CXX_COMPILER_LAUNCHER"]
        printed = "".join(self.run_document("docs/networks.md").values())
        self.assertIn("3 of 3 nodes configured, started", printed)
        self.assertIn("4 of 4 nodes Operational at the end", printed)
        self.check_that_a_node_is_booted_again()

    def check_that_a_node_is_booted_again(self) -> None:
        """As the document says: it is reported as lost, and booted again."""
        master = self.programs["line"]
        self.programs["can_2057c"].process.send_signal(signal.SIGKILL)
        master.wait_for("outputs: lost, last state .*")
        self.programs.pop("can_2057c").end()
        self.run_command("build/demo/examples/nodes/can_2057c $BUS --node-id 1 &")
        master.wait_for("outputs: booted", 2)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
