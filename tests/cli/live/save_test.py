#!/usr/bin/env python3
"""edsc save with live nodes on the virtual bus of `edsc bus`.

    save_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import re
import subprocess
import sys
import time
from pathlib import Path

from live import EDSC, FAILED, FINE, LIVE_NODES, SHEET, WRONG_USAGE, LiveTest, entry, run
from network import Network

sys.path.insert(0, str(Path(__file__).parents[2] / "masters"))
from slaves import Habits, Slave  # noqa: E402

FOREIGN = (f"[FileInfo]\nFileName=foreign.eds\nEDSVersion=4.0\n[DeviceInfo]\nVendorNumber=0x1234\nProductNumber=0x10001\n"
           "BaudRate_250=1\nNrOfRXPDO=0\nNrOfTXPDO=0\n[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n"
           "[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n"
           "[ManufacturerObjects]\nSupportedObjects=2\n1=0x2000\n2=0x2001\n" +
           entry("1000", "Device type", 7, "ro", "0x000F0191") + entry("1001", "Error register", 5, "ro", 0) +
           entry("1017", "Producer heartbeat time", 6, "rw", 0) +
           "\n[1018]\nParameterName=Identity\nObjectType=9\nSubNumber=3\n" + entry("1018sub0", "Number", 5, "ro", 2) +
           entry("1018sub1", "Vendor-ID", 7, "ro", "0x1234") + entry("1018sub2", "Product code", 7, "ro", "0x10001") +
           entry("2000", "Speed", 6, "rw", 0) + entry("2001", "Label", 9, "rw", ""))

NOT_COMPARED = "edsc: node 5: not compared: revision number (not in foreign.eds)\n"


class Save(LiveTest):
    def values_of(self, dcf: str) -> dict[str, str]:
        """Returns the ParameterValues of a DCF by section."""
        sections = re.findall(r"\[([^\]]+)\]\n([^\[]*)", (self.folder / dcf).read_text())
        return {name: value[1] for name, text in sections if (value := re.search("^ParameterValue=(.*)$", text, re.MULTILINE))}

    def commissioning(self, dcf: str) -> str:
        return re.search(r"\[DeviceComissioning\]\n([^\[]*)", (self.folder / dcf).read_text())[1]

    def set_values(self) -> None:
        for name, value in (("1017h", "250"), ("2002h", "left axis"), ("2003h", "-0.25"), ("2008h:02", "21"), ("6040h", "6")):
            self.assertEqual(self.edsc("write", 5, name, value, "--eds", "device.eds").returncode, FINE)

    def test_it_saves_what_differs_from_the_eds(self) -> None:
        self.set_values()
        result = self.edsc("save", 5, "device.eds", "-o", "axis.dcf", "--bit-rate", 250)
        self.assertRegex(result.stdout, r"^node 5: \d+ entries read, 4 values saved to axis.dcf, 2 skipped \(process data\)\n$")
        self.assertEqual((result.stderr, result.returncode), ("", FINE))
        self.assertEqual(self.values_of("axis.dcf"), {"1017": "250", "2002": "left axis", "2003": "-0.25", "2008sub2": "21"})
        self.assertIn("NodeID=5\n", self.commissioning("axis.dcf"))
        self.assertIn("Baudrate=250\n", self.commissioning("axis.dcf"))
        checked = subprocess.run([EDSC, "check", "axis.dcf"], cwd=self.folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(checked.returncode, FINE, checked.stderr)
        frames = self.network.frames("000", "605")
        self.assertFalse([frame for frame in frames if frame[:3] == "000"], "save sends no NMT command")
        self.assertFalse([frame for frame in frames if frame[4:12] in ("40 10 10", "40 11 10")], "no command is read")

    def test_on_standard_output(self) -> None:
        result = self.edsc("save", 5, "device.eds")
        self.assertTrue(result.stdout.startswith("[FileInfo]\n"))
        self.assertRegex(result.stderr, r"^node 5: \d+ entries read, 0 values saved, 2 skipped \(process data\)\n$")

    def test_all_values(self) -> None:
        found = self.expect_json(self.edsc("save", 5, "device.eds", "-o", "all.dcf", "--all", "--format", "json"),
                                 "save.schema.json")
        self.assertEqual(found["saved"] + len(found["process_data"]), found["read"])
        self.assertEqual([row["index"] for row in found["process_data"]], ["6040h:00", "60FFh:00"])
        values = self.values_of("all.dcf")
        self.assertEqual((values["2004"], values["1A00sub0"]), ("1000", "2"))
        self.assertNotIn("1010sub1", values)

    def test_a_device_that_lost_its_power_gets_it_back(self) -> None:
        self.set_values()
        self.assertEqual(self.edsc("save", 5, "device.eds", "-o", "before.dcf").returncode, FINE)
        self.network.close()
        self.network = Network(EDSC, LIVE_NODES, 5)
        self.addCleanup(self.network.close)
        self.assertEqual(self.edsc("configure", 5, "before.dcf").returncode, FINE)
        self.assertEqual(self.edsc("save", 5, "device.eds", "-o", "after.dcf").returncode, FINE)
        self.assertEqual((self.folder / "before.dcf").read_text(), (self.folder / "after.dcf").read_text())
        self.assertEqual(self.values_of("after.dcf")["2002"], "left axis")

    def test_a_mapping_that_differs_is_saved_as_a_whole(self) -> None:
        (self.folder / "one.dcf").write_text(re.sub(
            r"(\[1A00sub0\][^\[]*?)PDOMapping", r"\g<1>ParameterValue=1\nPDOMapping",
            SHEET.read_text() + "\n[DeviceComissioning]\nNodeID=5\n", flags=re.DOTALL))
        self.assertEqual(self.edsc("configure", 5, "one.dcf").returncode, FINE)
        self.assertEqual(self.edsc("save", 5, "device.eds", "-o", "axis.dcf").returncode, FINE)
        self.assertEqual(self.values_of("axis.dcf"), {"1A00sub0": "1", "1A00sub1": "0x60410010"})

    def test_a_dcf_keeps_the_values_that_are_not_read(self) -> None:
        text = SHEET.read_text() + "\n[DeviceComissioning]\nNodeID=5\n"
        for section, value in (("2006", 77), ("2007", -5), ("2004", 1200), ("1020sub1", 15000), ("6040", 6)):
            text, count = re.subn(rf"(\[{section}\][^\[]*?)PDOMapping", rf"\g<1>ParameterValue={value}\nPDOMapping", text)
            self.assertEqual(count, 1)
        (self.folder / "old.dcf").write_text(text)
        result = self.edsc("save", 5, "old.dcf", "-o", "axis.dcf")
        self.assertEqual((result.stderr, result.returncode), ("", FINE))
        self.assertEqual(self.values_of("axis.dcf"), {"2004": "1000", "2006": "77", "2007": "-5"})

    def test_another_device(self) -> None:
        (self.folder / "other.eds").write_text(SHEET.read_text().replace("0x00001001", "0x00001002"))
        result = self.edsc("save", 5, "other.eds", "-o", "axis.dcf")
        self.expect(result, FAILED, stderr="edsc: node 5 is not the device of other.eds: product code is 00001001h, expected "
                    '00001002h; "edsc scan BUS --eds FILE" finds the node of a file; --force saves anyway\n')
        self.assertFalse((self.folder / "axis.dcf").exists())
        self.assertEqual(self.edsc("save", 5, "other.eds", "-o", "axis.dcf", "--force").returncode, FINE)
        self.expect(self.edsc("save", 9, "device.eds", "--timeout", "50ms"), FAILED, stderr="edsc: node 9 does not answer\n")

    def test_wrong_usage(self) -> None:
        for arguments in (("device.eds", "--format", "json"), ("missing.eds",), ("device.eds", "-o", "device.eds/x.dcf")):
            self.assertEqual(self.edsc("save", 5, *arguments).returncode, WRONG_USAGE, arguments)


class SaveOfForeignSlaves(LiveTest):
    nodes = ()

    def setUp(self) -> None:
        super().setUp()
        (self.folder / "foreign.eds").write_text(FOREIGN)

    def slave(self, habits: Habits | None = None) -> Slave:
        slave = Slave(5, habits or Habits())

        def answer(frame: str) -> list[str]:
            can_id, *data = frame.split()
            slave.take(int(can_id, 16), bytes.fromhex("".join(data)), time.monotonic())
            return [f"{can_id:03X} {data.hex(' ')}" for can_id, data in slave.due(time.monotonic())]

        self.network.device(answer)
        return slave

    def test_a_power_cycle(self) -> None:
        slave = self.slave()
        slave.entries[(0x2000, 0)] = b"\x34\x12"
        slave.entries[(0x2001, 0)] = b"a label of twenty one"
        self.expect(self.edsc("save", 5, "foreign.eds", "-o", "before.dcf"), FINE,
                    "node 5: 3 entries read, 2 values saved to before.dcf\n", NOT_COMPARED)
        slave.reset()
        slave.outbox.clear()  # configure must not receive its boot-up message
        result = self.edsc("configure", 5, "before.dcf")
        self.assertEqual(result.returncode, FINE, result.stderr)
        self.assertIn("2 of 2 values written, 2 verified", result.stdout)
        self.assertEqual(slave.entries[(0x2001, 0)], b"a label of twenty one")
        self.assertEqual(self.edsc("save", 5, "foreign.eds", "-o", "after.dcf").returncode, FINE)
        self.assertEqual((self.folder / "before.dcf").read_text(), (self.folder / "after.dcf").read_text())

    def test_a_device_that_restarts_in_the_middle(self) -> None:
        slave = self.slave()
        slave.entries[(0x2000, 0)] = b"\x34\x12"
        upload = slave.take

        def take(can_id: int, data: bytes, now: float) -> None:
            upload(can_id, data, now)
            if data[:4] == bytes.fromhex("40002000"):
                slave.reset()

        slave.take = take
        self.expect(self.edsc("save", 5, "foreign.eds", "-o", "axis.dcf"), FAILED, "",
                    NOT_COMPARED + "edsc: node 5 has restarted while its values were read; nothing saved\n")
        self.assertFalse((self.folder / "axis.dcf").exists())

    def test_what_cannot_be_read_or_written_is_listed(self) -> None:
        slave = self.slave()
        del slave.entries[(0x1017, 0)]
        slave.entries[(0x2000, 0)] = b"\x34\x12\0\0"
        slave.entries[(0x2001, 0)] = b"two\nlines"
        result = self.edsc("save", 5, "foreign.eds", "-o", "axis.dcf")
        self.assertEqual((result.stdout, result.returncode), ("node 5: 2 entries read, 0 values saved to axis.dcf, 3 not saved\n",
                                                              FAILED))
        self.assertEqual(result.stderr.splitlines()[-3:], [
            "edsc: 1017h:00 Producer heartbeat time: refused by the device: 0602 0000h, object does not exist",
            "edsc: 2000h:00 Speed: a DCF cannot hold the value 4660 (00001234h) (4 bytes, UNSIGNED16 has 2)",
            'edsc: 2001h:00 Label: a DCF cannot hold the value "two\\x0Alines"'])

    def test_a_number_without_bytes_is_listed(self) -> None:
        slave = self.slave()
        slave.entries[(0x2000, 0)] = b""
        result = self.edsc("save", 5, "foreign.eds", "-o", "axis.dcf")
        self.assertEqual(result.returncode, FAILED)
        self.assertEqual(result.stderr.splitlines()[-1],
                         "edsc: 2000h:00 Speed: a DCF cannot hold the value nothing (0 bytes, UNSIGNED16 has 2)")


if __name__ == "__main__":
    run()
