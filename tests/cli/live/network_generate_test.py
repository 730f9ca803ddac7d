#!/usr/bin/env python3
"""The files of edsc network generate configure live nodes, and the PDO of one arrives at the other.

    network_generate_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import struct
import subprocess

from live import EDSC, FINE, LiveTest, run

PLANT = """{
  "bit_rate": 500,
  "nodes": {"a": {"node_id": 5, "eds": "device.eds", "serial_number": 256},
            "b": {"node_id": 6, "eds": "device.eds", "serial_number": 257, "set": {"speed": 1200}}},
  "signals": [{"from": "a", "object": "position_actual_value", "to": "b.target_velocity", "event": true}]
}
"""
REMAP_B = ["605 23 00 14 01 06 02 00 80", "605 2F 00 16 00 00 00 00 00", "605 23 00 16 01 20 00 FF 60",
           "605 2F 00 16 00 01 00 00 00", "605 23 00 14 01 85 01 00 00"]


class Generated(LiveTest):
    nodes = (5, 6)

    def setUp(self) -> None:
        super().setUp()
        (self.folder / "plant.json").write_text(PLANT)
        result = subprocess.run([EDSC, "network", "generate", "plant.json", "-o", "."], cwd=self.folder, capture_output=True,
                                text=True)
        self.assertEqual(result.returncode, FINE, result.stderr)

    def expect_link(self) -> None:
        """Node 5 sends its position, 123456, on entering Operational; node 6 gets it as target velocity."""
        client = self.network.client()
        self.expect(self.edsc("nmt", "start", 6), FINE)
        self.expect(self.edsc("nmt", "start", 5), FINE)
        while client.receive() != "185 40 E2 01 00":
            pass
        self.expect(self.edsc("read", 6, "60FFh", "2004h", "--eds", "device.eds"), FINE,
                    "60FFh:00 Target velocity = 123456 inc/s\n2004h:00 Speed = 1200 rpm\n")
        self.network.close()

    def test_configured_by_the_dcfs(self) -> None:
        for node, name in ((5, "a"), (6, "b")):
            result = self.edsc("configure", node, f"{name}.dcf")
            self.assertEqual(result.returncode, FINE, result.stdout + result.stderr)
        self.expect_link()

    def test_configured_by_the_concise_dcfs(self) -> None:
        """A device accepts the entries in their order, written one after the other as an NMT master does."""
        client = self.network.client()
        for node, name in ((5, "a"), (6, "b")):
            stream = (self.folder / f"{name}.cdcf").read_bytes()
            count, stream = struct.unpack_from("<I", stream)[0], stream[4:]
            for _ in range(count):
                index, sub_index, size = struct.unpack_from("<HBI", stream)
                data, stream = stream[7:7 + size], stream[7 + size:]
                address = f"{index & 0xFF:02X} {index >> 8:02X} {sub_index:02X}"
                client.send(f"60{node} {0x23 | 4 - size << 2:02X} {address} {data.ljust(4, bytes(1)).hex(' ').upper()}")
                while not (answer := client.receive()).startswith(f"58{node} "):
                    pass
                self.assertEqual(answer, f"58{node} 60 {address} 00 00 00 00")
            self.assertEqual(stream, b"")
        self.expect_link()
        written = [frame for frame in self.network.log if frame.startswith("606 2")]
        self.assertEqual([frame.replace("606", "605", 1) for frame in written if frame[7:9] == "00"], REMAP_B)


if __name__ == "__main__":
    run()
