#!/usr/bin/env python3
"""edsc lss with live nodes on the virtual bus of `edsc bus`.

    lss_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import subprocess

from live import FAILED, FINE, WRONG_USAGE, LiveTest, run


class Lss(LiveTest):
    nodes = (5, 255)
    address = ("--vendor", "0xABCDEF", "--product", "1001h", "--revision", "10002h", "--serial", "257")
    product = address[:6]
    shown = "vendor-ID 00ABCDEFh, product code 00001001h, revision 00010002h, serial number 00000101h"

    def lss(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        return self.edsc("lss", "--timeout", "2000ms", "--step", "50ms", *arguments)

    def test_assign_by_address(self) -> None:
        self.expect(self.lss("assign", *self.address, "--node-id", 7, "--store"), FINE,
                    self.shown + ": node-ID 7, stored\n")
        self.assertEqual(self.network.frames("7E5", "7E4"), [
            "7E5 04 00 00 00 00 00 00 00",
            "7E5 40 EF CD AB 00 00 00 00", "7E5 41 01 10 00 00 00 00 00",
            "7E5 42 02 00 01 00 00 00 00", "7E5 43 01 01 00 00 00 00 00", "7E4 44 00 00 00 00 00 00 00",
            "7E5 5E 00 00 00 00 00 00 00", "7E4 5E FF 00 00 00 00 00 00",
            "7E5 11 07 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00",
            "7E5 17 00 00 00 00 00 00 00", "7E4 17 00 00 00 00 00 00 00",
            "7E5 5E 00 00 00 00 00 00 00", "7E4 5E FF 00 00 00 00 00 00",
            "7E5 04 00 00 00 00 00 00 00"])

    def test_the_new_node_answers(self) -> None:
        self.lss("assign", *self.address, "--node-id", 7)
        self.expect(self.edsc("read", 7, "1018h:04", "--type", "u32"), FINE, "1018h:04 = 257 (00000101h)\n")

    def test_fastscan(self) -> None:
        self.expect(self.lss("fastscan", *self.product), FINE, self.shown + "\n")
        found = self.expect_json(self.lss("fastscan", *self.product, "--format", "json"), "lss.schema.json")
        self.assertEqual([device["serial_number"] for device in found["unconfigured"]], [0x101])
        self.expect(self.lss("assign", *self.product, "--node-id", 7), FINE, self.shown + ": node-ID 7\n")
        self.expect(self.lss("fastscan"), FAILED, stderr="edsc: fastscan: no device without node-ID answers\n")

    def test_a_scan_with_fastscan(self) -> None:
        found = self.expect_json(self.edsc("scan", "--nodes", 9, "--for", "0ms", "--timeout", "2000ms", "--lss", "--step", "50ms", "--format", "json"),
                                 "scan.schema.json")
        self.assertEqual([device["serial_number"] for device in found["unconfigured"]], [0x101])

    def test_what_a_device_refuses(self) -> None:
        for arguments, words in ((("--node-id", 126), "node-id: refused: error 1, the node-ID is out of the slave's range"),
                                 (("--node-id", 7, "--bit-rate", 800),
                                  "bit-rate: refused: error 1, the slave does not have this bit rate"),
                                 (("--node-id", 125, "--store"),
                                  "store: refused: error 2, the slave cannot access its storage")):
            with self.subTest(arguments=arguments):
                self.expect(self.lss("assign", *self.address, *arguments), FAILED, stderr=f"edsc: {words}\n")
        self.expect(self.lss("select", *self.address[:-1], 9), FAILED, stderr="edsc: select: no answer\n")

    def test_step_by_step(self) -> None:
        self.expect(self.lss("inquire"), FAILED, stderr="edsc: inquire: no answer\n")
        for arguments in (("select", *self.address), ("node-id", 9), ("bit-rate", 250), ("store",)):
            self.expect(self.lss(*arguments), FINE)
        self.expect(self.lss("inquire"), FINE, self.shown + ", no node-ID\n")
        found = self.expect_json(self.lss("inquire", "--format", "json"), "lss.schema.json")
        self.assertEqual((found["address"]["product_code"], found["node_id"]), (0x1001, None))
        self.expect(self.lss("activate", "--delay", "20ms"), FINE)
        self.expect(self.lss("state", "waiting"), FINE)
        self.expect(self.edsc("read", 9, "1000h", "--type", "u32"), FINE, "1000h:00 = 131474 (00020192h)\n")

    def test_wrong_usage(self) -> None:
        for arguments in ((), ("node-id", 128), ("node-id",), ("bit-rate", 300), ("select", "--vendor", 1),
                          ("assign", "--node-id", 5, "--serial", 4), ("state", "off")):
            self.assertEqual(self.lss(*arguments).returncode, WRONG_USAGE, arguments)


class LssWithoutFastscan(LiveTest):
    nodes = ()

    def test_it_says_that_a_slave_answers_lss(self) -> None:
        self.network.device(lambda frame: ["7E4 50 00 00 00 00 00 00 00"] if frame.startswith("7E5 4C") else [])
        words = ("edsc: fastscan: a device without node-ID answers LSS, but did not answer the first Fastscan request, "
                 "sent twice; it may be slow (--step) or not have Fastscan: with no other device on the bus, \"edsc lss BUS "
                 "state configuration\" and \"inquire\" show its numbers for \"assign\"\n")
        self.expect(self.edsc("lss", "--timeout", "2000ms", "fastscan"), FAILED, stderr=words)
        self.expect(self.edsc("lss", "--timeout", "2000ms", "assign", "--node-id", 7), FAILED, stderr=words)


if __name__ == "__main__":
    run()
