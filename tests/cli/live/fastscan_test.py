#!/usr/bin/env python3
"""LSS Fastscan with slaves that answer every frame of it, on the virtual bus of `edsc bus`.

    fastscan_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import signal

from live import EDSC, FAILED, FINE, INTERRUPTED, LIVE_NODES, LiveTest, run
from network import Network


class FastscanSlave:
    """A slave of CiA 305 without node-ID; in configuration state it responds to every Fastscan frame, as a common stack does.
    `always`: also in waiting state."""

    def __init__(self, address: tuple[int, int, int, int], always: bool = False) -> None:
        self.address, self.always = address, always
        self.configuration, self.position = False, 0

    def answer(self, frame: str) -> list[str]:
        can_id, *words = frame.split()
        data = bytes.fromhex("".join(words))
        if can_id != "7E5":
            return []
        if data[0] == 0x04:
            self.configuration = data[1] == 1
        if self.configuration and 0x5A <= data[0] <= 0x5D:
            number = self.address[data[0] - 0x5A].to_bytes(4, "little").hex(" ")
            return [f"7E4 {data[0]:02X} {number} 00 00 00"]
        return ["7E4 4F 00 00 00 00 00 00 00"] if data[0] == 0x51 and self.is_meant(data) else []

    def is_meant(self, data: bytes) -> bool:
        number, bit, sub, following = int.from_bytes(data[1:5], "little"), *data[5:8]
        if self.configuration or self.always:
            return True
        if bit == 0x80:
            self.position = 0
            return True
        if self.position != sub or (number ^ self.address[sub]) >> bit:
            return False
        if bit == 0:
            self.position = following
            self.configuration = following < sub
        return True


class FastscanOfSlavesThatAnswerAlways(LiveTest):
    nodes = ()
    numbers = ("--step", "50ms", "--timeout", "2000ms", "fastscan", "--vendor", "93h", "--product", 2, "--revision", 3)
    shown = "vendor-ID 00000093h, product code 00000002h, revision 00000003h, serial number {:08X}h"

    def slaves(self, *serials: int, always: bool = False) -> None:
        for serial in serials:
            self.network.device(FastscanSlave((0x93, 2, 3, serial), always).answer)

    def test_one(self) -> None:
        self.slaves(0x15011234)
        self.expect(self.edsc("lss", *self.numbers), FINE, self.shown.format(0x15011234) + "\n")

    def test_two(self) -> None:
        self.slaves(0x15011234, 0x15011230)
        self.expect(self.edsc("lss", *self.numbers), FINE,
                    self.shown.format(0x15011230) + "\n" + self.shown.format(0x15011234) + "\n")

    def test_one_that_answers_always(self) -> None:
        self.slaves(0x15011234, always=True)
        result = self.edsc("lss", *self.numbers)
        self.assertEqual((result.returncode, result.stdout), (FAILED, ""))
        self.assertIn("fastscan: found " + self.shown.format(0), result.stderr)
        self.assertIn("no slave with this address answers an inquiry", result.stderr)

    def test_what_was_found_is_shown_on_an_interruption(self) -> None:
        for arguments in (("lss", *self.numbers), ("lss", *self.numbers, "--format", "json"),
                          ("scan", "--nodes", 9, "--for", "0ms", "--timeout", "2000ms", "--lss", "--step", "50ms")):
            with self.subTest(arguments), Network(EDSC, LIVE_NODES) as network:
                self.network = network
                self.slaves(0x15011234, 0x15011238)
                listener = network.client()
                process = self.start(*arguments)
                while listener.receive()[:6] != "7E4 5D":  # the first slave has sent its last number
                    pass
                while not listener.receive().startswith("7E5 51"):
                    pass
                process.send_signal(signal.SIGINT)
                stdout, stderr = process.communicate(timeout=600)
                self.assertEqual((process.returncode, stderr), (INTERRUPTED, "edsc: interrupted\n"))
                if arguments[0] == "scan":
                    self.assertIn("without node-ID: vendor-ID", stdout)
                elif "json" in arguments:
                    self.assertEqual([row["serial_number"] for row in json.loads(stdout)["unconfigured"]], [0x15011234])
                else:
                    self.assertEqual(stdout, self.shown.format(0x15011234) + "\n")


if __name__ == "__main__":
    run()
