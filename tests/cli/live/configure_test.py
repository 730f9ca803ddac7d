#!/usr/bin/env python3
"""edsc configure with live nodes on the virtual bus of `edsc bus`.

    configure_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import re
import struct
import subprocess
from pathlib import Path

from live import EDSC, FAILED, FINE, LIVE_NODES, WRONG_USAGE, LiveTest, run
from network import Network


class Configure(LiveTest):
    left_out = "2"  # in the DCF with all values: 1020h

    def dcf(self, **values: str) -> Path:
        """Writes the DCF of node 5 with these ParameterValues: `x2004="1200"`."""
        path = self.folder / "axis.dcf"
        subprocess.run([EDSC, "format", self.folder / "device.eds", "--dcf", "--all", "--node-id", "5", "-o", path], check=True)
        text = path.read_text()
        for section, value in values.items():
            pattern = rf"(\[{section[1:]}\][^\[]*?ParameterValue=)[^\n]*"
            text, count = re.subn(pattern, rf"\g<1>{value}", text, flags=re.IGNORECASE)
            self.assertEqual(count, 1, section)
        path.write_text(text)
        return path

    def only(self, **values: str) -> Path:
        """Writes the same without other ParameterValues."""
        path = self.dcf(**values)
        kept, section = [], ""
        for line in path.read_text().splitlines():
            section = line[1:-1].lower() if line.startswith("[") else section
            if not line.startswith("ParameterValue") or "x" + section in (name.lower() for name in values):
                kept.append(line)
        path.write_text("\n".join(kept) + "\n")
        return path

    def test_what_differs_and_again_nothing(self) -> None:
        self.dcf(x2004="1200", x1017="250")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--store"), FINE, """\
1017h:00 Producer heartbeat time: 0 ms -> 250 ms
2004h:00 Speed: 1000 rpm -> 1200 rpm
node 5: 2 of 25 values differ; 2 of 2 values written, 2 verified, LEFT skipped, 1020h written, stored
""".replace("LEFT", self.left_out))
        self.expect(self.edsc("read", 5, "2004h", "1017h", "1020h:01", "1020h:02", "--eds", "device.eds"), FINE, """\
2004h:00 Speed = 1200 rpm
1017h:00 Producer heartbeat time = 250 ms
1020h:01 Verify configuration, Configuration date = 00003C0Ch
1020h:02 Verify configuration, Configuration time = 52200000 ms
""")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    f"node 5: 0 of 25 values differ, {self.left_out} skipped\n")
        frames = self.network.frames("605")
        self.assertIn("605 23 10 10 01 73 61 76 65", frames)
        self.assertEqual([frame for frame in frames if frame[4] == "2" and frame[7:12] not in ("20 10", "10 10")],
                         ["605 2B 17 10 00 FA 00 00 00", "605 2B 04 20 00 B0 04 00 00"])

    def test_an_edited_value_is_written_though_the_date_is_the_same(self) -> None:
        self.only(x2004="1200")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "2004h:00 Speed: 1000 rpm -> 1200 rpm\n"
                    "node 5: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written\n")
        self.only(x2004="1300")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "2004h:00 Speed: 1200 rpm -> 1300 rpm\n"
                    "node 5: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written\n")

    def test_all_values(self) -> None:
        self.dcf(x2004="1200", x1017="250")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--all"), FINE,
                    f"node 5: 25 of 25 values written, 25 verified, {self.left_out} skipped, 1020h written\n")

    def test_a_dry_run_writes_nothing(self) -> None:
        self.only(x2004="1200", x1017="0", x1A00sub0="1", x1A00sub1="0x60640020")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--dry-run"), FINE, """\
1A00h:00 TPDO mapping parameter 1, Number of mapped objects: 2 -> 1
1A00h:01 TPDO mapping parameter 1, Mapping entry 1: 60410010h -> 60640020h
2004h:00 Speed: 1000 rpm -> 1200 rpm
steps:
write       2004h:00 Speed = 1200 rpm
switch off  1800h:01 TPDO communication parameter 1, COB-ID used by TPDO
clear       1A00h:00 TPDO mapping parameter 1, Number of mapped objects
write       1A00h:01 TPDO mapping parameter 1, Mapping entry 1 = 60640020h
write       1A00h:00 TPDO mapping parameter 1, Number of mapped objects = 1
switch on   1800h:01 TPDO communication parameter 1, COB-ID used by TPDO as before
node 5: 3 of 4 values differ; nothing written
""")
        found = self.expect_json(self.edsc("configure", 5, "axis.dcf", "--dry-run", "--format", "json"),
                                 "configure.schema.json")
        self.assertEqual([(row["index"], row["before"], row["wanted"]) for row in found["changes"]],
                         [("1A00h:00", "2", "1"), ("1A00h:01", "60410010h", "60640020h"), ("2004h:00", "1000 rpm", "1200 rpm")])
        frames = self.network.frames("000", "605")
        self.assertEqual([frame for frame in frames if frame[:3] == "000" or frame[4] != "4"], [])

    def test_a_write_only_value_is_written_each_time(self) -> None:
        self.only(x2004="1000")
        path = self.folder / "axis.dcf"
        path.write_text(re.sub(r"(\[2006\][^\[]*?)PDOMapping", r"\g<1>ParameterValue=5\nPDOMapping", path.read_text()))
        for _ in range(2):
            result = self.edsc("configure", 5, "axis.dcf")
            self.assertEqual(result.returncode, FINE, result.stderr)
            self.assertIn("2006h:00 Password: (write-only) -> 5\n"
                          "node 5: 0 of 2 values differ, 1 cannot be compared; 1 of 1 value written, 0 verified",
                          result.stdout)

    def test_node_id_and_bit_rate_need_their_flag(self) -> None:
        sheet = self.folder / "device.eds"
        sheet.write_text(sheet.read_text().replace("ParameterName=Speed", "ParameterName=CAN bit rate"))
        self.only(x2004="1200", x1017="250")
        withheld = "edsc: not written, the node's own node-ID or bit rate: 2004h:00 CAN bit rate{} (--node-id-and-bit-rate writes it)\n"
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "1017h:00 Producer heartbeat time: 0 ms -> 250 ms\n"
                    "node 5: 1 of 2 values differs; 1 of 1 value written, 1 verified, 1 not written (node-ID, bit rate)\n",
                    withheld.format(": 1000 rpm -> 1200 rpm"))
        self.expect(self.edsc("configure", 5, "axis.dcf", "--all"), FINE,
                    "node 5: 1 of 1 value written, 1 verified, 1 not written (node-ID, bit rate)\n",
                    withheld.format(" = 1200 rpm"))
        found = self.expect_json(self.edsc("configure", 5, "axis.dcf", "--format", "json"), "configure.schema.json")
        self.assertEqual([row["index"] for row in found["withheld"]], ["2004h:00"])
        self.assertFalse(found["configured_already"])
        self.expect(self.edsc("configure", 5, "axis.dcf", "--node-id-and-bit-rate"), FINE,
                    "2004h:00 CAN bit rate: 1000 rpm -> 1200 rpm\n"
                    "node 5: 1 of 2 values differs; 1 of 1 value written, 1 verified, 1020h written\n")

    def test_a_node_that_restarts_in_the_middle(self) -> None:
        self.only(x2004="1500", x1017="250")
        values = {"04 20 00": "E8 03", "17 10 00": "00 00"}

        def answer(frame: str) -> list[str]:
            command, entry = frame[4:6], frame[7:15]
            if frame[:3] != "605":
                return []
            if entry not in values:
                return [f"585 80 {entry} 00 00 02 06"]
            if command == "40":
                return [f"585 4B {entry} {values[entry]} 00 00"]
            return [f"585 60 {entry} 00 00 00 00", "705 00"]

        with Network(EDSC, LIVE_NODES) as network:
            self.network = network
            network.device(answer)
            result = self.edsc("configure", 5, "axis.dcf", "--force", "--store", "--start")
            self.assertEqual(result.returncode, FAILED)
            self.assertIn("edsc: node 5 restarted during the configuration: values written before may be lost", result.stderr)
            frames = network.frames("605", "000")
            self.assertFalse([frame for frame in frames if frame.startswith(("605 23 10 10", "000 01"))])

    def test_a_pdo_goes_off_before_its_mapping_changes(self) -> None:
        self.only(x1A00sub0="1", x1A00sub1="0x60640020", x1800sub1="0x40000185", x1800sub5="100")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--all", "--start"), FINE,
                    "node 5: 4 of 4 values written, 4 verified, 1020h written\n")
        frames = self.network.frames("000", "605")
        self.assertLess(frames.index("000 80 05"), frames.index("605 23 00 18 01 85 01 00 80"))
        self.assertEqual(frames[-1], "000 01 05")
        self.assertEqual([frame for frame in frames if frame[4] == "2" and frame[7:12] != "20 10"], [
            "605 23 00 18 01 85 01 00 80",
            "605 2F 00 1A 00 00 00 00 00",
            "605 23 00 1A 01 20 00 64 60",
            "605 2F 00 1A 00 01 00 00 00",
            "605 2B 00 18 05 64 00 00 00",
            "605 23 00 18 01 85 01 00 40",
        ])

    def test_of_a_pdo_only_what_differs_is_written(self) -> None:
        self.only(x1A00sub0="2", x1A00sub1="0x60410010", x1A00sub2="0x60640020", x1800sub1="0x00000185", x1800sub5="100")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE, """\
1800h:05 TPDO communication parameter 1, Event timer: 0 ms -> 100 ms
node 5: 1 of 5 values differs; 1 of 1 value written, 1 verified, 1020h written
""")
        self.only(x1A00sub0="2", x1A00sub1="0x60410010", x1A00sub2="0x60410010")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE, """\
1A00h:02 TPDO mapping parameter 1, Mapping entry 2: 60640020h -> 60410010h
node 5: 1 of 3 values differs; 3 of 3 values written, 3 verified, 1020h written
""")
        frames = self.network.frames("605")
        self.assertEqual([frame for frame in frames if frame[4] == "2" and frame[7:12] != "20 10"], [
            "605 23 00 18 01 85 01 00 80",
            "605 2B 00 18 05 64 00 00 00",
            "605 23 00 18 01 85 01 00 00",
            "605 23 00 18 01 85 01 00 80",
            "605 2F 00 1A 00 00 00 00 00",
            "605 23 00 1A 01 10 00 41 60",
            "605 23 00 1A 02 10 00 41 60",
            "605 2F 00 1A 00 02 00 00 00",
            "605 23 00 18 01 85 01 00 00",
        ])

    def test_one_entry_of_a_mapping_leaves_the_others_mapped(self) -> None:
        self.only(x1A00sub1="0x60410010")
        self.only(x1A00sub2="0x60410010")
        self.edsc("configure", 5, "axis.dcf")
        self.expect(self.edsc("read", 5, "1A00h:00", "--type", "u8"), FINE, "1A00h:00 = 2\n")
        self.only(x1A00sub1="0x60640020")
        self.assertEqual(self.edsc("configure", 5, "axis.dcf").returncode, FINE)
        self.expect(self.edsc("read", 5, "1A00h:00", "--type", "u8"), FINE, "1A00h:00 = 2\n")

    def test_answers_that_tell_no_size_are_cut_to_the_type(self) -> None:
        self.only(x2004="1500", x1017="250")
        values = {"04 20 00": "00 00", "17 10 00": "00 00"}

        def answer(frame: str) -> list[str]:
            can_id, command, entry, data = frame[:3], frame[4:6], frame[7:15], frame[16:21]
            if can_id != "605":
                return []
            if command != "40":
                values[entry] = data
            if entry not in values:
                return [f"585 80 {entry} 00 00 02 06"]
            return [f"585 42 {entry} {values[entry]} EE EE" if command == "40" else f"585 60 {entry} 00 00 00 00"]

        with Network(EDSC, LIVE_NODES) as network:
            self.network = network
            network.device(answer)
            result = self.edsc("configure", 5, "axis.dcf", "--force", "--format", "json")
            found = self.expect_json(result, "configure.schema.json")
        self.assertEqual((found["written"], found["verified"], found["failures"]), (2, 2, []))
        self.assertEqual((values["04 20 00"], values["17 10 00"]), ("DC 05", "FA 00"))

    def test_the_steps_without_a_bus(self) -> None:
        self.only(x1A00sub0="1", x1A00sub1="0x60640020", x2004="1200", x1005="0x81")
        result = subprocess.run([EDSC, "configure", "socketcan:none", "5", "axis.dcf", "--dry-run", "--all"],
                                cwd=self.folder,
                                capture_output=True, text=True, timeout=600)
        self.expect(result, FINE, """\
switch off  1005h:00 COB-ID SYNC
switch on   1005h:00 COB-ID SYNC = 00000081h
write       2004h:00 Speed = 1200 rpm
switch off  1800h:01 TPDO communication parameter 1, COB-ID used by TPDO
clear       1A00h:00 TPDO mapping parameter 1, Number of mapped objects
write       1A00h:01 TPDO mapping parameter 1, Mapping entry 1 = 60640020h
write       1A00h:00 TPDO mapping parameter 1, Number of mapped objects = 1
switch on   1800h:01 TPDO communication parameter 1, COB-ID used by TPDO as before
""")

        result = subprocess.run([EDSC, "configure", "socketcan:none", "5", "axis.dcf", "--dry-run", "--all", "--format",
                                 "json"], cwd=self.folder, capture_output=True, text=True, timeout=600)
        found = self.expect_json(result, "configure.schema.json")
        self.assertEqual([(step["action"], step["index"], step["value"]) for step in found["steps"][:4]],
                         [("switch off", "1005h:00", None), ("switch on", "1005h:00", "00000081h"),
                          ("write", "2004h:00", "1200 rpm"), ("switch off", "1800h:01", None)])
        self.assertTrue(found["dry_run"])

    def test_values_that_wait_for_others_are_tried_again(self) -> None:
        self.only(x2004="4000", x2005="5000")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE, """\
2004h:00 Speed: 1000 rpm -> 4000 rpm
2005h:00 Maximum speed: 3000 rpm -> 5000 rpm
node 5: 2 of 2 values differ; 2 of 2 values written, 2 verified, 1020h written
""")
        written = [frame for frame in self.network.frames("605") if frame[4] == "2" and frame[7:12] != "20 10"]
        self.assertEqual(written, ["605 2B 04 20 00 A0 0F 00 00", "605 2B 05 20 00 88 13 00 00",
                                   "605 2B 04 20 00 A0 0F 00 00"])

    def test_what_is_refused_is_named_with_its_line(self) -> None:
        path = self.only(x2004="4000", x1A00sub0="2", x1A00sub1="0x60640020", x1A00sub2="0x20020008", x2009="7")
        lines = path.read_text().splitlines()
        speed, mapping, rounded = (next(i for i, line in enumerate(lines, 1) if line == f"ParameterValue={value}")
                                   for value in ("4000", "0x20020008", "7"))
        self.expect(self.edsc("configure", 5, "axis.dcf", "--all", "--store"), FAILED,
                    "node 5: 2 of 5 values written, 1 verified, 3 failed\n", f"""\
edsc: axis.dcf: 1 error; invalid objects are skipped ("edsc check --keep-going" lists them)
axis.dcf:{mapping}:16: error: 1A00h:02 TPDO mapping parameter 1, Mapping entry 2 = 20020008h: refused by the device: 0604 0041h, object cannot be mapped to the PDO; the related entries are not changed, but 1800h:01 remains disabled
axis.dcf:{speed}:16: error: 2004h:00 Speed = 4000 rpm: refused by the device: 0609 0031h, value too high
axis.dcf:{rounded}:16: error: 2009h:00 Rounded value = 7: reads back as 0
""")
        self.expect(self.edsc("read", 5, "1800h:01", "--eds", "device.eds"), FINE,
                    "1800h:01 TPDO communication parameter 1, COB-ID used by TPDO = 80000185h not_valid\n")

    def test_another_device(self) -> None:
        path = self.only(x2004="1200")
        path.write_text(path.read_text().replace("0x00001001", "0x00001002"))
        self.expect(self.edsc("configure", 5, "axis.dcf"), FAILED,
                    stderr="edsc: node 5 is not the device of axis.dcf: product code is 00001001h, expected "
                           '00001002h; "edsc scan BUS --eds FILE" finds the node of a file; --force writes anyway\n')
        self.expect(self.edsc("configure", 5, "axis.dcf", "--force"), FINE,
                    "2004h:00 Speed: 1000 rpm -> 1200 rpm\n"
                    "node 5: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written\n")

    def test_another_device_whose_dcf_has_no_vendor(self) -> None:
        path = self.only(x2004="1200")
        path.write_text(path.read_text().replace("0x00ABCDEF", "0").replace("0x00020192", "0x00040191"))
        result = self.edsc("configure", 5, "axis.dcf")
        self.assertEqual((result.returncode, result.stdout), (FAILED, ""))
        self.assertIn("device type is 00020192h, expected 00040191h; ", result.stderr)
        path.write_text(path.read_text().replace("0x00040191", "0x00020192"))
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "2004h:00 Speed: 1000 rpm -> 1200 rpm\n"
                    "node 5: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written\n",
                    "edsc: node 5: not compared: vendor-ID (not in axis.dcf)\n")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE, "node 5: 0 of 1 value differ\n",
                    "edsc: node 5: not compared: vendor-ID (not in axis.dcf)\n")
        self.assertEqual([frame for frame in self.network.frames("000", "605")
                          if frame.startswith("000") or frame[4:15] == "2B 04 20 00"],
                         ["000 80 05", "605 2B 04 20 00 B0 04 00 00"])

    def test_a_stopped_node(self) -> None:
        self.only(x2004="1200")
        self.edsc("nmt", "stop", 5)
        result = self.edsc("configure", 5, "axis.dcf", "--timeout", "5000ms")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))

    def test_the_dcf_of_another_node(self) -> None:
        self.only(x2004="1200")
        for options in ((), ("--dry-run",), ("--dry-run", "--all")):
            result = subprocess.run([EDSC, "configure", "socketcan:none", "6", "axis.dcf", *options], cwd=self.folder,
                                    capture_output=True, text=True, timeout=600)
            self.expect(result, FAILED,
                        stderr="edsc: axis.dcf is for node 5, not for node 6 (--force writes anyway)\n")
        self.expect(self.edsc("configure", 6, "axis.dcf", "--timeout", "50ms", "--force"), FAILED,
                    stderr="edsc: node 6 does not answer\n")
        self.assertEqual(self.edsc("configure", 6, "axis.dcf", "--dry-run", "--all", "--force").returncode, FINE)
        path = self.folder / "axis.dcf"
        path.write_text(path.read_text().replace("NodeID=5", "NodeID=7").replace("NodeId=5", "NodeId=7"))
        self.expect(self.edsc("configure", 5, "axis.dcf"), FAILED,
                    stderr="edsc: axis.dcf is for node 7, not for node 5 (--force writes anyway)\n")

    def test_a_concise_dcf(self) -> None:
        self.only(x2004="1200", x1017="250")
        subprocess.run([EDSC, "format", "axis.dcf", "--concise", "-o", "axis.bin"], cwd=self.folder, check=True)
        unknown = ("edsc: node 5: not compared: identity (a concise DCF does not state it; "
                   "--eds names the EDS of the device)\n")
        self.expect(self.edsc("configure", 5, "axis.bin", "--concise"), FINE,
                    "1017h:00: 00 00 -> FA 00\n2004h:00: E8 03 -> B0 04\n"
                    "node 5: 2 of 2 values differ; 2 of 2 values written, 2 verified\n", unknown)
        self.expect(self.edsc("configure", 5, "axis.bin", "--concise", "--eds", "device.eds"), FINE,
                    "node 5: 0 of 2 values differ\n")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--concise"), WRONG_USAGE,
                    stderr="edsc: axis.dcf is not a concise DCF: its length does not match its contents\n")
        self.expect(self.edsc("configure", 5, ".", "--concise"), WRONG_USAGE, stderr="edsc: .: Is a directory\n")
        self.expect(self.edsc("configure", 5, "device.eds"), WRONG_USAGE,
                    stderr='edsc: device.eds is not a DCF; "edsc format --dcf" makes one from an EDS\n')

    def test_a_concise_dcf_with_a_write_only_value(self) -> None:
        (self.folder / "axis.bin").write_bytes(struct.pack("<IHBIIHBIH", 2, 0x2006, 0, 4, 77, 0x2004, 0, 2, 1200))
        result = self.edsc("configure", 5, "axis.bin", "--concise", "--all")
        self.assertEqual((result.stdout, result.returncode), ("node 5: 2 of 2 values written, 1 verified\n", FINE), result.stderr)

    def test_as_json(self) -> None:
        path = self.only(x2004="4000")
        line = path.read_text().splitlines().index("ParameterValue=4000") + 1
        found = self.expect_json(self.edsc("configure", 5, "axis.dcf", "--format", "json"), "configure.schema.json", FAILED)
        self.assertEqual(found["failures"], [{"index": "2004h:00", "name": "Speed", "line": line,
                                              "text": "refused by the device: 0609 0031h, value too high"}])


if __name__ == "__main__":
    run()
