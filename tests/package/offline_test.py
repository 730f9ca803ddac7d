#!/usr/bin/env python3
"""EDSC_OFFLINE builds edsc without the commands for a live bus, and without their headers and libraries.

    offline_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

The build is in the folder offline beside BUILD_DIR, where relative paths are the same: ccache has the objects of the compiler.
"""

from __future__ import annotations

import re
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, BUILD_DIR = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve().parent / "offline"
SHEET = SOURCE_DIR / "eds/cpd.eds"
LIVE_HEADERS = re.compile(r"/(linux/can\S*|net/if\.h|sys/socket\.h|termios\.h|httplib\.h|nettle/\S*)")
LIVE_COMMANDS = {"scan", "read", "write", "configure", "save", "monitor", "nmt", "send", "lss", "conform", "accept", "bus", "node",
                 "record", "watch", "replay", "discover", "edit"}
OTHER_COMMANDS = {"generate", "check", "dump", "format", "diff", "document", "lsp", "merge", "new", "object", "overlay", "network", "decode", "audit",
                  "plot", "completion", "help", "version"}
LOG = "(0.000000) can0 705#00\n(0.100000) can0 000#0105\n(0.200000) can0 185#3706\n"


def run(*arguments: object, status: int = 0) -> str:
    result = subprocess.run([*map(str, arguments)], capture_output=True, text=True, timeout=3600)
    if result.returncode != status:
        raise AssertionError(f"{arguments}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


class Offline(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        run("cmake", "-S", SOURCE_DIR, "-B", BUILD_DIR, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DEDSC_OFFLINE=ON",
            "-DEDSC_COMMIT_IN_VERSION=OFF")
        run("cmake", "--build", BUILD_DIR, "--target", "edsc")
        cls.edsc = BUILD_DIR / "generator/edsc"

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_needs_no_header_of_a_bus(self) -> None:
        used = run("ninja", "-C", BUILD_DIR, "-t", "deps")
        self.assertIn("nlohmann", used)
        self.assertEqual(set(LIVE_HEADERS.findall(used)), set())

    def test_has_the_other_commands(self) -> None:
        named = set(re.findall(r"^  ([a-z]+)  ", run(self.edsc, "--help"), re.MULTILINE))
        self.assertEqual(named, OTHER_COMMANDS)
        for shell in ("bash", "zsh", "man"):
            text = run(self.edsc, "completion", shell)
            for command in LIVE_COMMANDS:
                self.assertNotRegex(text, rf"edsc {command}\b")
        for command in LIVE_COMMANDS:
            self.assertIn("unknown command", run(self.edsc, command, status=2))
        for command in ("scan", "verify", "apply"):
            self.assertNotRegex(run(self.edsc, "network", "--help"), rf"network {command}|^  {command} ")

    def test_reads_and_generates(self) -> None:
        run(self.edsc, "check", SHEET)
        run(self.edsc, "generate", SHEET, "-o", self.folder)
        self.assertTrue((self.folder / "cpd/dictionary.hpp").is_file())
        run(self.edsc, "document", SHEET, "-o", self.folder / "cpd.html")

    def test_reads_logs(self) -> None:
        log = self.folder / "a.log"
        log.write_text(LOG)
        self.assertIn("boot-up", run(self.edsc, "decode", log, "--node", f"5={SHEET}"))
        run(self.edsc, "audit", log, "--node", f"5={SHEET}")
        capture = self.folder / "a.pcap"
        header = struct.pack("<IHHIIII", 0xA1B2C3D4, 2, 4, 0, 0, 262144, 227)
        capture.write_bytes(header + struct.pack("<IIII", 1, 0, 9, 9) + bytes.fromhex("000007050100000000"))
        self.assertIn("boot-up", run(self.edsc, "decode", capture, "--node", f"5={SHEET}"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
