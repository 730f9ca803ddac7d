#!/usr/bin/env python3
"""`edsc new`: what it writes passes `check --strict` and `format --check`, and a device of it passes the conformance test, for each
profile and option. The device is one of `edsc node`, on a bus of its own.

    new_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

EDSC = Path(sys.argv[2]).resolve()
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2
IDENTITY = ("--vendor-name", "Acme", "--vendor", "0x1234", "--product-name", "D1", "--product", "1", "--revision", "0x10000")
# The options of each new device.
DEVICES = {
    "none": (),
    "io": ("--cia", "401", "--heartbeat", "100ms"),
    "drive": ("--cia", "402",),
    "modes": ("--cia", "402", "--modes", "csp,pp,vl,pv,tq,hm,csv,cst", "--tpdo-objects", "6041h,6064h", "--tpdo-objects", "606Ch",
              "--rpdo-objects", "6040h,607Ah", "--bit-rates", "125,500,1000"),
    "meter": ("--cia", "404", "--with-storage"),
    "encoder": ("--cia", "406", "--with-lss"),
    "every": ("--cia", "401", "--with-lss", "--with-storage", "--heartbeat", "1s"),
}


class New(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def edsc(self, *words: object, status: int = FINE) -> subprocess.CompletedProcess[str]:
        result = subprocess.run([EDSC, *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=3000)
        self.assertEqual(result.returncode, status, f"{words}: {result.stdout}{result.stderr}")
        return result

    def dump(self, name: str) -> dict:
        return json.loads(self.edsc("dump", name).stdout)

    def test_passes_the_checks(self) -> None:
        for name, options in DEVICES.items():
            with self.subTest(name):
                result = self.edsc("new", f"{name}.eds", *IDENTITY, *options)
                self.assertEqual(result.stdout, f"{name}.eds\n")
                self.edsc("check", "--strict", f"{name}.eds")
                self.edsc("format", "--check", f"{name}.eds")
                device = self.dump(f"{name}.eds")
                self.assertEqual((device["vendor_number"], device["product_number"], device["revision_number"]), (0x1234, 1, 0x10000))

    def test_states_what_the_options_say(self) -> None:
        self.edsc("new", "modes.eds", *IDENTITY, *DEVICES["modes"], "--heartbeat", "250ms")
        device = self.dump("modes.eds")
        entries = {(one["index"], one["sub_index"]): one for item in device["objects"] for one in item["entries"]}
        self.assertEqual(entries[0x1017, 0]["default_value"], 250)
        self.assertEqual(entries[0x6502, 0]["default_value"], 0b11_1010_1111)
        self.assertEqual(entries[0x6060, 0]["default_value"], 8)
        self.assertEqual(device["device_info"]["baud_rates"], [125, 500, 1000])
        mapped = {(pdo["direction"], pdo["number"]): [one["index"] for one in pdo["entries"]] for pdo in device["pdos"]}
        self.assertEqual(mapped, {("receive", 1): [0x6040, 0x607A], ("transmit", 1): [0x6041, 0x6064], ("transmit", 2): [0x606C]})

    def test_conforms(self) -> None:
        with subprocess.Popen([EDSC, "bus", "--listen", "127.0.0.1:0", *DEVICES], stdout=subprocess.PIPE, text=True) as bus:
            addresses = [bus.stdout.readline().strip() for _ in DEVICES]
            try:
                with ThreadPoolExecutor(len(DEVICES)) as pool:
                    list(pool.map(self.conform, DEVICES, addresses))
            finally:
                bus.terminate()

    def conform(self, name: str, address: str) -> None:
        options = DEVICES[name]
        self.edsc("new", f"{name}.eds", *IDENTITY, *options)
        with subprocess.Popen([EDSC, "node", address, f"{name}.eds", "--node-id", "5"], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, text=True) as node:
            try:
                node.stdout.readline()
                store = ("--store",) if "--with-storage" in options else ()
                report = self.edsc("conform", address, 5, f"{name}.eds", "--level", "communication", "--quiet", *store).stdout
            finally:
                node.terminate()
        self.assertIn("passed: none of ", report)

    def test_does_not_overwrite(self) -> None:
        (self.folder / "a.eds").write_text("")
        self.edsc("new", "a.eds", "--vendor-name", "Acme", status=WRONG_USAGE)
        self.assertEqual((self.folder / "a.eds").read_text(), "")
        (self.folder / "b.eds").symlink_to("missing.eds")
        self.edsc("new", "b.eds", "--vendor-name", "Acme", status=WRONG_USAGE)
        self.assertFalse((self.folder / "missing.eds").exists())
        (self.folder / ".gitattributes").write_text("mine\n")
        self.edsc("new", "c.eds", "--vendor-name", "Acme", "--git", status=WRONG_USAGE)
        self.assertFalse((self.folder / "c.eds").exists())

    def test_writes_the_attributes_of_git(self) -> None:
        self.edsc("new", "a.eds", "--vendor-name", "Acme", "--git")
        subprocess.run(["git", "init", "-q"], cwd=self.folder, check=True)
        checked = subprocess.run(["git", "check-attr", "merge", "diff", "--", "a.eds"], cwd=self.folder, capture_output=True, text=True, check=True)
        self.assertEqual(checked.stdout, "a.eds: merge: edsc\na.eds: diff: eds\n")

    def test_wrong_options(self) -> None:
        for words in (("--modes", "pp"), ("--cia", "402", "--modes", "xx"), ("--bit-rates", "123"), ("--heartbeat", "1500us"),
                      ("--tpdo-objects", "speed")):
            self.edsc("new", "a.eds", "--vendor-name", "Acme", *words, status=WRONG_USAGE)
        self.edsc("new", "a.txt", "--vendor-name", "Acme", status=WRONG_USAGE)
        self.edsc("new", "a.eds", "--vendor-name", "Acme", "--tpdo-objects", "2000h", status=INPUT_HAS_ERRORS)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
