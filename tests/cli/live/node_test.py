#!/usr/bin/env python3
"""edsc node runs an EDS as a node: python-can, with an SDO client of its own, is the master on a bus of edsc bus.

    node_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import configparser
import struct
import sys
import time
import unittest

from node_bus import FAILED, NMT, PATIENCE, RESET_NODE, START, WRONG_USAGE, NodeOnBus, device
from sdo import Abort, SdoClient

OPERATIONAL = 0x05
PRE_OPERATIONAL = 0x7F


def default_value(name: str, section: str) -> int:
    """The number that the EDS states, read without edsc."""
    eds = configparser.ConfigParser(interpolation=None, strict=False)
    eds.read(device(name), encoding="latin-1")
    return int(eds[section]["DefaultValue"], 0)


class NodeTest(NodeOnBus):
    def test_boot_up_identity_and_heartbeat(self) -> None:
        process, lines = self.node(device("cpc-tc1"), "--node-id", 5)
        self.assertRegex(lines[0], rf'\Anode 5 ".+" on {self.address}\n\Z')
        self.expect_frame(0x705, b"\0")
        sdo = SdoClient(self.wire, 5, PATIENCE)
        for sub_index in (1, 2, 3):
            expected = default_value("cpc-tc1", f"1018sub{sub_index}")
            self.assertEqual(sdo.upload(0x1018, sub_index), struct.pack("<I", expected))
        sdo.download(0x1017, 0, struct.pack("<H", 50))
        self.expect_frame(0x705, bytes([PRE_OPERATIONAL]))
        self.wire.send(NMT, bytes([START, 5]))
        self.expect_frame(0x705, bytes([OPERATIONAL]))
        with self.assertRaises(Abort) as refused:
            sdo.upload(0x2FFF, 0)
        self.assertEqual(refused.exception.code, 0x0602_0000)
        self.end(process)

    def test_pdos(self) -> None:
        """RPDO 1 of the drive is the controlword, TPDO 1 the statusword (eds/cpc-tc1.eds)."""
        self.node(device("cpc-tc1"), "--node-id", 6, "--set", "6041h=592")
        self.expect_frame(0x706, b"\0")
        self.wire.send(NMT, bytes([START, 0]))
        self.expect_frame(0x186, struct.pack("<H", 592))
        sdo = SdoClient(self.wire, 6, PATIENCE)
        self.wire.send(0x206, bytes([0x0F, 0x00]))
        end = time.monotonic() + PATIENCE
        while sdo.upload(0x6040, 0) != b"\x0f\0" and time.monotonic() < end:
            pass
        self.assertEqual(sdo.upload(0x6040, 0), b"\x0f\0")

    def test_nodes_receive_the_frames_of_each_other(self) -> None:
        """Node 11 monitors the heartbeat of node 10 on the same connection: EMCY 8130h follows when that ends."""
        _, lines = self.node(device("cpd"), "--node-id", 10, "--count", 3, ready=3)
        self.assertEqual([line.split()[1] for line in lines], ["10", "11", "12"])
        for node_id in (10, 11, 12):
            self.expect_frame(0x700 + node_id, b"\0")
        producer, consumer = SdoClient(self.wire, 10, PATIENCE), SdoClient(self.wire, 11, PATIENCE)
        producer.download(0x1017, 0, struct.pack("<H", 50))
        consumer.download(0x1016, 1, struct.pack("<I", 10 << 16 | 2000))
        self.assertIsNone(self.wire.receive(0x08B, 3.0))
        producer.download(0x1017, 0, struct.pack("<H", 0))
        emergency = self.wire.receive(0x08B, PATIENCE)
        self.assertIsNotNone(emergency)
        self.assertEqual(struct.unpack_from("<H", emergency)[0], 0x8130)

    def test_values_of_the_command_line_survive_resets(self) -> None:
        self.node(device("cpd"), "--node-id", 5, "--set", "1017h=70", "--set", "1018h:04=1234")
        self.expect_frame(0x705, b"\0")
        sdo = SdoClient(self.wire, 5, PATIENCE)
        sdo.download(0x1017, 0, struct.pack("<H", 500))
        self.wire.send(NMT, bytes([RESET_NODE, 5]))
        self.expect_frame(0x705, b"\0")
        self.assertEqual(sdo.upload(0x1017, 0), struct.pack("<H", 70))
        self.assertEqual(sdo.upload(0x1018, 4), struct.pack("<I", 1234))

    def test_stored_parameters_in_a_file(self) -> None:
        arguments = (device("cpd"), "--node-id", 5, "--memory", "drive.mem")
        process, _ = self.node(*arguments)
        self.expect_frame(0x705, b"\0")
        sdo = SdoClient(self.wire, 5, PATIENCE)
        sdo.download(0x1017, 0, struct.pack("<H", 777))
        sdo.download(0x1010, 1, b"save")
        self.end(process)
        self.node(*arguments)
        self.expect_frame(0x705, b"\0")
        self.assertEqual(sdo.upload(0x1017, 0), struct.pack("<H", 777))

    def test_different_devices(self) -> None:
        _, lines = self.node("--node", f"5={device('cpd')}", "--node", f"6={device('rk5c')}", ready=2)
        self.assertEqual([line.split()[1] for line in lines], ["5", "6"])
        for node_id, name in ((5, "cpd"), (6, "rk5c")):
            self.expect_frame(0x700 + node_id, b"\0")
            expected = default_value(name, "1018sub2")
            self.assertEqual(SdoClient(self.wire, node_id, PATIENCE).upload(0x1018, 2), struct.pack("<I", expected))

    def test_what_cannot_be_a_node(self) -> None:
        broken = self.folder / "broken.eds"
        broken.write_text(device("cpd").read_text(encoding="latin-1").replace("DataType=0x0007", "DataType=0x7777", 1))
        self.assertIn("7777", self.refused(FAILED, broken, "--node-id", 5))
        self.assertIn("--node-id", self.refused(WRONG_USAGE, device("cpd")))
        self.assertIn("two nodes have the node-ID 5",
                      self.refused(WRONG_USAGE, device("cpd"), "--node-id", 5, "--node", f"5={device('rk5c')}"))
        self.assertIn("node-ID 128 is above 127", self.refused(WRONG_USAGE, device("cpd"), "--node-id", 127, "--count", 2))
        self.assertIn("no_such.eds", self.refused(WRONG_USAGE, "no_such.eds", "--node-id", 5))
        self.assertIn("--memory", self.refused(WRONG_USAGE, device("cpd"), "--node-id", 5, "--count", 2, "--memory", "file"))
        self.assertIn("folder", self.refused(WRONG_USAGE, device("cpd"), "--node-id", 5, "--memory", "no_such_folder/file"))

    def test_files_of_others_are_not_overwritten(self) -> None:
        eds = self.folder / "drive.eds"
        content = device("cpd").read_bytes()
        eds.write_bytes(content)
        (self.folder / "other.txt").write_text("not the values of a node")
        for option, name, message in (("--log", "drive.eds", "is the same file as the input"),
                                      ("--memory", "drive.eds", "is the same file as the input"),
                                      ("--memory", "other.txt", "is not a file of stored values")):
            with self.subTest(option=option, name=name):
                self.assertIn(message, self.refused(WRONG_USAGE, eds, "--node-id", 5, option, name))
        self.assertEqual(eds.read_bytes(), content)
        self.assertEqual((self.folder / "other.txt").read_text(), "not the values of a node")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
