#!/usr/bin/env python3
"""edsc scan, read, write, configure, save, monitor, record, lss and nmt with live nodes on the virtual bus of `edsc bus`.

    live_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import fcntl
import json
import os
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest
from pathlib import Path

import jsonschema

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[2] / "masters")]
from network import Network  # noqa: E402
from slaves import Habits, Slave  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
LIVE_NODES = Path(sys.argv[3]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/live_device.eds"
FINE, FAILED, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130
PATIENCE_MS = 60_000  # for an answer that must be received, even on a busy machine
ABORT_GENERAL = "605 80 17 10 00 00 00 00 08"


def entry(section: str, name: str, data_type: int, access: str, value: object) -> str:
    return (f"\n[{section}]\nParameterName={name}\nObjectType=7\nDataType={data_type}\nAccessType={access}\n"
            f"DefaultValue={value}\nPDOMapping=0\n")


HISTORY = ("\n[1003]\nParameterName=Pre-defined error field\nObjectType=8\nSubNumber=3\n" +
           entry("1003sub0", "Number of errors", 5, "rw", 0) + entry("1003sub1", "Error 1", 7, "ro", 0) +
           entry("1003sub2", "Error 2", 7, "ro", 0) +
           "\n[2010]\nParameterName=Log\nObjectType=8\nSubNumber=3\n" + entry("2010sub0", "Number", 5, "ro", 2) +
           entry("2010sub1", "Row 1", 7, "ro", 0) + entry("2010sub2", "Row 2", 7, "ro", 0))


class LiveTest(unittest.TestCase):
    maxDiff = None
    nodes: tuple[int, ...] = (5,)

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-live-"))
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(SHEET, self.folder / "device.eds")
        self.network = Network(EDSC, LIVE_NODES, *self.nodes)
        self.addCleanup(self.network.close)

    def command(self, command: str, *arguments: object) -> list[str]:
        if command in ("read", "write", "configure", "save") and "--timeout" not in arguments:
            arguments = (*arguments, "--timeout", PATIENCE_MS)
        return [str(EDSC), command, self.network.address, *map(str, arguments)]

    def edsc(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(command, *arguments), cwd=self.folder, capture_output=True, text=True,
                              timeout=600)

    def start(self, command: str, *arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(self.command(command, *arguments), cwd=self.folder, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def expect(self, result: subprocess.CompletedProcess[str], exit_code: int, stdout: str = "", stderr: str = "") -> None:
        self.assertEqual((result.stdout, result.stderr, result.returncode), (stdout, stderr, exit_code))

    def expect_json(self, result: subprocess.CompletedProcess[str], schema: str, exit_code: int = FINE) -> dict:
        self.assertEqual(result.returncode, exit_code, result.stderr)
        found = json.loads(result.stdout)
        jsonschema.validate(found, json.loads((SOURCE_DIR / "docs/schema" / schema).read_text()))
        return found


class Scan(LiveTest):
    nodes = (5, 6)
    fast = ("--timeout", 5000, "--listen", 100)
    some = ("--nodes", "1..16")  # all are queried at the same time

    def test_it_tells_who_is_there(self) -> None:
        self.expect(self.edsc("scan", *self.some, *self.fast), FINE, """\
node  state  vendor-ID  product    revision   serial     device type                                   name
   5  -      00ABCDEFh  00001001h  00010002h  00000100h  00020192h CiA 402, drives and motion control  Live device
   6  -      00ABCDEFh  00001001h  00010002h  00000101h  00020192h CiA 402, drives and motion control  Live device
""")

    def test_it_waits_for_a_heartbeat_that_it_knows_of(self) -> None:
        self.edsc("write", 6, "1017h", 300, "--type", "u16")
        self.edsc("nmt", "start", 6)
        found = self.expect_json(self.edsc("scan", *self.some, *self.fast, "--format", "json"), "scan.schema.json")
        self.assertEqual([(node["node_id"], node["state"]) for node in found["nodes"]], [(5, None), (6, "operational")])

    def test_it_names_the_data_sheet_that_fits(self) -> None:
        text = SHEET.read_text()
        (self.folder / "newer.eds").write_text(text.replace("0x00010002", "0x00010003"))
        (self.folder / "next.eds").write_text(text.replace("0x00010002", "0x00020000"))
        (self.folder / "other.eds").write_text(text.replace("0x00001001", "0x00001002"))
        sheets = [word for name in ("device", "newer", "next", "other") for word in ("--eds", f"{name}.eds")]
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets)
        self.assertTrue(result.stdout.splitlines()[1].endswith(
            "device.eds, newer.eds (other minor revision), next.eds (other major revision)"), result.stdout)
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds", "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["data_sheets"], [])

    def test_it_says_why_a_file_fits_no_node(self) -> None:
        text = SHEET.read_text()
        (self.folder / "other.eds").write_text(text.replace("0x00001001", "0x00001002"))
        (self.folder / "serial.dcf").write_text(
            text.replace("0x00020192", "0x00040191") + "\n[DeviceComissioning]\nNodeID=6\nLSS_SerialNumber=0x101\n")
        result = self.edsc("scan", *self.some, *self.fast, "--eds", "device.eds", "--eds", "other.eds", "--eds", "serial.dcf")
        self.assertEqual(result.stdout.splitlines()[3:], [
            "other.eds does not match any node; node 5 is the closest: product code is 00001001h, expected 00001002h",
            "serial.dcf does not match any node; node 6 is the closest: device type is 00020192h, expected 00040191h"])
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds")
        self.assertEqual(result.stdout.splitlines()[2:],
                         ["other.eds does not match any node; node 5: product code is 00001001h, expected 00001002h"])
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds", "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["misfits"],
                         [{"file": "other.eds", "differences": "product code is 00001001h, expected 00001002h"}])

    def test_an_eds_without_vendor_fits_by_its_other_numbers(self) -> None:
        text = re.sub(r"0x00ABCDEF", "0", SHEET.read_text())
        (self.folder / "no_vendor.eds").write_text(text)
        (self.folder / "other_type.eds").write_text(text.replace("0x00020192", "0x00040191"))
        sheets = ("--eds", "no_vendor.eds", "--eds", "other_type.eds")
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets)
        self.assertTrue(result.stdout.splitlines()[1].endswith("no_vendor.eds (vendor-ID not compared)"), result.stdout)
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets, "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["data_sheets"],
                         [{"file": "no_vendor.eds", "fit": "same device", "not_compared": ["vendor_id"]}])

    def test_it_says_that_a_file_has_errors(self) -> None:
        (self.folder / "broken.eds").write_text(SHEET.read_text().replace("DefaultValue=1000", "DefaultValue=fast"))
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "broken.eds")
        self.assertEqual(result.stderr, 'edsc: broken.eds: 1 error; what is wrong is left out ("edsc check --keep-going" '
                         "lists it)\n")
        self.assertEqual(result.returncode, FINE)

    def test_it_asks_only_the_nodes_that_it_is_told(self) -> None:
        self.assertEqual(self.edsc("scan", "--nodes", "6..9", *self.fast).stdout.count("Live device"), 1)
        self.assertNotIn("605", [frame.split()[0] for frame in self.network.frames()])

    def test_a_stopped_node_is_known_by_its_heartbeat(self) -> None:
        self.edsc("write", 5, "1017h", 50, "--type", "u16")
        self.edsc("nmt", "stop", 5)
        result = self.edsc("scan", "--nodes", "5", *self.fast)
        self.assertEqual(result.stdout.splitlines()[1].split(), ["5", "stopped", *"-----"[:4], *"no answer over SDO".split(), "-"])


class ScanOfAnEmptyBus(LiveTest):
    nodes = ()

    def test_nothing_is_there(self) -> None:
        self.expect(self.edsc("scan", "--timeout", 20, "--listen", 20), FAILED,
                    stderr=f"edsc: no node answers on {self.network.address}\n")

    def test_a_bus_that_is_not_there(self) -> None:
        self.network.close()
        result = self.edsc("scan")
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
        self.assertIn("Connection refused", result.stderr)

    def test_what_is_no_address(self) -> None:
        result = subprocess.run([EDSC, "scan", "can0"], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertTrue(result.stderr.startswith('edsc: "can0" is not a bus address'), result.stderr)


class Read(LiveTest):
    def test_by_name_with_unit(self) -> None:
        self.expect(self.edsc("read", 5, "position_actual_value", "2007h", "--eds", "device.eds"), FINE, """\
6064h:00 Position actual value = 123456 inc
2007h:00 Temperature = -12
""")

    def test_all_entries_of_an_object(self) -> None:
        self.expect(self.edsc("read", 5, "1018h", "--eds", "device.eds"), FINE, """\
1018h:00 Identity object, Highest sub-index supported = 4
1018h:01 Identity object, Vendor-ID = 00ABCDEFh
1018h:02 Identity object, Product code = 00001001h
1018h:03 Identity object, Revision number = 00010002h
1018h:04 Identity object, Serial number = 00000100h
""")

    def test_without_a_data_sheet(self) -> None:
        self.expect(self.edsc("read", 5, "1018h:01", "0x1008"), FINE,
                    "1018h:01 = EF CD AB 00\n1008h:00 = 4C 69 76 65 20 64 65 76 69 63 65\n")
        self.expect(self.edsc("read", 5, "1018h:01", "--type", "u32"), FINE, "1018h:01 = 11259375 (00ABCDEFh)\n")
        self.expect(self.edsc("read", 5, "speed"), WRONG_USAGE,
                    stderr='edsc: "speed" is not an address such as 1018h:01; names require an EDS (--eds)\n')

    def test_what_the_device_refuses(self) -> None:
        self.expect(self.edsc("read", 5, "2FFFh", "6064h"), FAILED, "6064h:00 = 40 E2 01 00\n",
                    "edsc: 2FFFh:00: refused by the device: 0602 0000h, object does not exist\n")
        self.expect(self.edsc("read", 5, "2006h"), FAILED,
                    stderr="edsc: 2006h:00: refused by the device: 0601 0001h, read of a write-only object\n")

    def test_a_node_that_is_not_there(self) -> None:
        self.expect(self.edsc("read", 9, "1018h:01", "1018h:02", "--timeout", 50), FAILED,
                    stderr="edsc: 1018h:01: no answer\nedsc: node 9 does not answer: 1 more not read\n")

    def test_all_as_json(self) -> None:
        found = self.expect_json(self.edsc("read", 5, "--all", "--eds", "device.eds", "--format", "json"), "read.schema.json")
        values = {(entry["index"], entry["sub_index"]): entry["value"] for entry in found["entries"]}
        self.assertEqual(values[0x6064, 0], 123456)
        self.assertEqual(values[0x2007, 0], -12)
        self.assertEqual(values[0x2003, 0], 1.5)
        self.assertEqual(values[0x2002, 0], "edsc")
        self.assertEqual(values[0x1800, 1], 0x185)
        self.assertNotIn((0x2001, 0), values)  # a DOMAIN
        self.assertNotIn((0x2006, 0), values)  # wo

    def test_a_refusal_as_json(self) -> None:
        found = self.expect_json(self.edsc("read", 5, "2FFFh", "--format", "json"), "read.schema.json", FAILED)
        self.assertEqual(found["entries"], [{
            "index": 0x2FFF, "sub_index": 0, "name": None, "type": None, "result": "refused",
            "abort_code": 0x06020000, "text": "refused by the device: 0602 0000h, object does not exist"}])

    def test_a_domain_goes_to_a_file_by_block_transfer(self) -> None:
        self.expect(self.edsc("read", 5, "log", "--eds", "device.eds", "--file", "log.bin"), FINE,
                    "2001h:00 Log: 3000 bytes to log.bin\n")
        self.assertEqual((self.folder / "log.bin").read_bytes(), b"\xA5" * 3000)
        self.assertEqual(self.network.frames("605")[0], "605 A4 01 20 00 7F 1C 00 00")

    def test_a_domain_on_the_screen(self) -> None:
        result = self.edsc("read", 5, "log", "--eds", "device.eds")
        self.assertEqual(result.stdout, "2001h:00 Log = " + "A5 " * 32 + "... (3000 bytes)\n")

    def test_wrong_usage(self) -> None:
        for arguments, words in (
                (("5",), "OBJECT or --all"),
                (("200", "1000h"), "not a node-ID"),
                (("5", "--all"), "--eds"),
                (("5", "1000h", "--eds", "missing.eds"), "missing.eds"),
                (("5", "speeed", "--eds", "device.eds"), "speed"),
                (("5", "1018h", "--eds", "device.eds", "--file", "x"), "one entry, not of 5")):
            with self.subTest(arguments=arguments):
                result = self.edsc("read", *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


class Silence(LiveTest):
    """Devices and buses that no longer respond."""
    nodes = ()

    def wait_for(self, process: subprocess.Popen[str]) -> tuple[int, str, str]:
        return process.wait(timeout=600), process.stdout.read(), process.stderr.read()

    def test_ctrl_c_aborts_the_transfer(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", 600_000)
        self.assertEqual(asked.receive(), "605 40 17 10 00 00 00 00 00")
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.wait_for(process), (INTERRUPTED, "", "edsc: interrupted\n"))
        self.assertEqual(self.network.frames(), ["605 40 17 10 00 00 00 00 00", ABORT_GENERAL])

    def test_the_bus_goes_away(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", 600_000)
        asked.receive()
        self.network.bus.kill()
        exit_code, stdout, stderr = self.wait_for(process)
        self.assertEqual((exit_code, stdout), (FAILED, ""))
        self.assertIn(": the bus is lost: ", stderr)

    def test_a_device_that_falls_silent_in_the_middle(self) -> None:
        answers = {"605 40 08 10 00 00 00 00 00": ["585 41 08 10 00 0B 00 00 00"]}
        self.network.device(lambda frame: answers.get(frame, []))
        self.expect(self.edsc("read", 5, "1008h", "--timeout", 50), FAILED, stderr="edsc: 1008h:00: no answer\n")
        self.assertEqual(self.network.frames("605")[-1], "605 80 08 10 00 00 00 04 05")

    def test_a_device_that_breaks_the_protocol(self) -> None:
        answers = {"605 40 08 10 00 00 00 00 00": ["585 41 08 10 00 0B 00 00 00"],
                   "605 60 00 00 00 00 00 00 00": ["585 10 41 42 43 44 45 46 47"]}
        self.network.device(lambda frame: answers.get(frame, []))
        self.expect(self.edsc("read", 5, "1008h"), FAILED,
                    stderr="edsc: 1008h:00: the transfer failed: 0503 0000h, toggle bit not alternated\n")

    def endless(self, initiate: str) -> None:
        """Starts a device whose uploads begin with this answer and never end."""
        def answer(frame: str) -> list[str]:
            if frame.startswith("605 40"):
                return [initiate.replace("xx xx xx", frame[7:15])]
            if frame[4:6] in ("60", "70"):
                return [f"585 {'00' if frame[4:6] == '60' else '10'} 41 42 43 44 45 46 47"]
            return []
        self.network.device(answer)

    def test_an_upload_that_brings_more_than_announced(self) -> None:
        self.endless("585 41 xx xx xx 03 00 00 00")
        self.expect(self.edsc("read", 5, "1008h"), FAILED, stderr="edsc: 1008h:00: the transfer failed: 0607 0012h, "
                    "value too long\n")
        self.assertEqual(self.network.frames("605")[-1], "605 80 08 10 00 12 00 07 06")

    def test_an_endless_upload_of_a_number(self) -> None:
        self.endless("585 40 xx xx xx 00 00 00 00")
        self.expect(self.edsc("read", 5, "1000h", "--eds", "device.eds"), FAILED,
                    stderr="edsc: 1000h:00 Device type: the value is longer than 68 bytes\n")
        self.assertEqual(self.network.frames("605")[-1], "605 80 00 10 00 12 00 07 06")

    def test_an_endless_upload_of_a_string(self) -> None:
        self.endless("585 40 xx xx xx 00 00 00 00")
        self.expect(self.edsc("read", 5, "1008h", "--eds", "device.eds", "--max-bytes", 700), FAILED,
                    stderr="edsc: 1008h:00 Manufacturer device name: the value is longer than 700 bytes\n")
        frames = self.network.frames("605")
        self.assertEqual((len(frames), frames[-1]), (103, "605 80 08 10 00 05 00 04 05"))

    def test_an_answer_that_tells_no_size_is_cut_to_the_type(self) -> None:
        answers = {"605 40 17 10 00 00 00 00 00": ["585 42 17 10 00 F4 01 EE EE"],
                   "605 40 08 10 00 00 00 00 00": ["585 42 08 10 00 41 42 00 00"],
                   "605 2B 04 20 00 DC 05 00 00": ["585 60 04 20 00 00 00 00 00"],
                   "605 40 04 20 00 00 00 00 00": ["585 42 04 20 00 DC 05 EE EE"]}
        self.network.device(lambda frame: answers.get(frame, []))
        self.expect(self.edsc("read", 5, "1017h", "1008h", "--eds", "device.eds"), FINE,
                    '1017h:00 Producer heartbeat time = 500 ms\n1008h:00 Manufacturer device name = "AB"\n')
        self.expect(self.edsc("read", 5, "1017h"), FINE, "1017h:00 = F4 01 EE EE\n")
        self.expect(self.edsc("write", 5, "speed", "1500", "--eds", "device.eds", "--verify"), FINE,
                    "2004h:00 Speed = 1500 rpm, verified\n")
        self.expect(self.edsc("write", 5, "2004h", "--raw", "DC", "05", "--verify"), FINE, "2004h:00 = DC 05, verified\n")

    def test_an_abort_of_another_entry_is_no_refusal(self) -> None:
        answers = {"605 40 17 10 00 00 00 00 00": ["585 80 00 00 00 05 00 04 05"]}
        self.network.device(lambda frame: answers.get(frame, []))
        self.expect(self.edsc("read", 5, "1017h", "--timeout", 5000), FAILED,
                    stderr="edsc: 1017h:00: no answer, but an abort of 0000h:00: 0504 0005h, out of memory\n")

    def test_a_block_transfer_that_breaks_is_tried_by_segments(self) -> None:
        def device(end_of_block: str, received: bytearray):
            """Returns the answers to a block download, which break off after its first segment."""
            def answer(frame: str) -> list[str]:
                if frame.startswith("605 C6 00 20 00"):
                    return ["585 A4 00 20 00 7F 00 00 00"]
                if frame.startswith("605 01 "):
                    return [end_of_block] if end_of_block else []
                if frame.startswith("605 21 00 20 00"):
                    received.clear()
                    answer.segmented = True
                    return ["585 60 00 20 00 00 00 00 00"]
                if answer.segmented and frame.startswith("605 "):
                    command = int(frame[4:6], 16)
                    received.extend(bytes.fromhex(frame[7:])[:7 - (command >> 1 & 7)])
                    return [f"585 {0x20 | command & 0x10:02X} 00 00 00 00 00 00 00"]
                return []
            answer.segmented = False
            return answer

        content = bytes(i % 7 for i in range(200))
        (self.folder / "firmware.bin").write_bytes(content)
        for end_of_block, words in (
                ("585 80 00 00 00 03 00 04 05", "no answer, but an abort of 0000h:00: 0504 0003h, invalid sequence number"),
                ("585 80 00 20 00 04 00 04 05", "refused by the device: 0504 0004h, CRC error"),
                ("", "no answer")):
            with self.subTest(end_of_block), Network(EDSC, LIVE_NODES) as network:
                self.network = network
                received = bytearray()
                network.device(device(end_of_block, received))
                self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin", "--timeout", 5000), FINE,
                            "2000h:00: 200 bytes from firmware.bin\n",
                            f"edsc: 2000h:00: the block transfer failed: {words}; trying a segmented transfer\n")
                self.assertEqual(bytes(received), content)

    def test_a_refusal_of_a_block_transfer_is_the_end(self) -> None:
        (self.folder / "firmware.bin").write_bytes(bytes(200))
        self.network.device(lambda frame: ["585 80 00 20 00 02 00 01 06"] if frame.startswith("605 C6") else [])
        self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin"), FAILED,
                    stderr="edsc: 2000h:00: refused by the device: 0601 0002h, write of a read-only object\n")

    def test_entries_without_a_value_are_no_failure(self) -> None:
        (self.folder / "history.eds").write_text(SHEET.read_text() + HISTORY)
        answers = {"605 40 03 10 00 00 00 00 00": ["585 4F 03 10 00 01 00 00 00"],
                   "605 40 03 10 01 00 00 00 00": ["585 43 03 10 01 10 23 00 00"],
                   "605 40 10 20 00 00 00 00 00": ["585 4F 10 20 00 02 00 00 00"],
                   "605 40 10 20 01 00 00 00 00": ["585 43 10 20 01 01 00 00 00"],
                   "605 40 10 20 02 00 00 00 00": ["585 80 10 20 02 24 00 00 08"]}
        default = lambda frame: [f"585 80 {frame[7:15]} 24 00 00 08"] if frame.startswith("605 40 ") else []
        self.network.device(lambda frame: answers.get(frame) or default(frame))
        self.expect(self.edsc("read", 5, "1003h", "2010h", "--eds", "history.eds"), FINE, """\
1003h:00 Pre-defined error field, Number of errors = 1
1003h:01 Pre-defined error field, Error 1 = 00002310h
2010h:00 Log, Number = 2
2010h:01 Log, Row 1 = 1
2010h:02 Log, Row 2: no value
""")
        result = self.edsc("read", 5, "--all", "--eds", "history.eds")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))
        self.assertNotIn("1003h:02", result.stdout)
        self.expect(self.edsc("read", 5, "1003h:02", "--eds", "history.eds"), FAILED,
                    stderr="edsc: 1003h:02 Pre-defined error field, Error 2: refused by the device: 0800 0024h, no data available\n")

    def test_block_transfer_falls_back_to_segments(self) -> None:
        segments = {"605 40 01 20 00 00 00 00 00": ["585 41 01 20 00 09 00 00 00"],
                    "605 60 00 00 00 00 00 00 00": ["585 00 01 02 03 04 05 06 07"],
                    "605 70 00 00 00 00 00 00 00": ["585 1B 08 09 00 00 00 00 00"]}
        refusal = {"605 A4 01 20 00 7F 1C 00 00": ["585 80 01 20 00 01 00 04 05"]}
        for name, answers in (("refused", segments | refusal), ("no answer", segments)):
            with self.subTest(name), Network(EDSC, LIVE_NODES) as network:
                self.network = network
                network.device(lambda frame, known=answers: known.get(frame, []))
                self.expect(self.edsc("read", 5, "log", "--eds", "device.eds", "--timeout", 5000), FINE,
                            "2001h:00 Log = 01 02 03 04 05 06 07 08 09 (9 bytes)\n")


class Write(LiveTest):
    def test_with_the_unit_and_read_back(self) -> None:
        self.expect(self.edsc("write", 5, "speed", "1500 rpm", "--eds", "device.eds", "--verify"), FINE,
                    "2004h:00 Speed = 1500 rpm, verified\n")
        self.expect(self.edsc("write", 5, "label", "left axis", "--eds", "device.eds"), FINE, '2002h:00 Label = "left axis"\n')
        self.expect(self.edsc("read", 5, "label", "speed", "--eds", "device.eds"), FINE,
                    '2002h:00 Label = "left axis"\n2004h:00 Speed = 1500 rpm\n')

    def test_a_value_in_brackets_is_no_list(self) -> None:
        self.expect(self.edsc("write", 5, "label", "--eds", "device.eds", "--timeout", PATIENCE_MS, "--", "[a,b]"), FINE, '2002h:00 Label = "[a,b]"\n')
        self.expect(self.edsc("write", 5, "label", "[a]", "[b]", "--eds", "device.eds"), FINE, '2002h:00 Label = "[a] [b]"\n')

    def test_without_a_data_sheet(self) -> None:
        self.expect(self.edsc("write", 5, "1017h", "500", "--type", "u16"), FINE, "1017h:00 = 500 (01F4h)\n")
        self.expect(self.edsc("write", 5, "1017h", "--raw", "F4", "01"), FINE, "1017h:00 = F4 01\n")
        self.assertEqual(self.network.frames("605"), ["605 2B 17 10 00 F4 01 00 00"] * 2)

    def test_limits_are_looked_at_first(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds"), WRONG_USAGE,
                    stderr='edsc: 6001 is above the high limit of 2005h:00 "Maximum speed", 6000\n')
        self.expect(self.edsc("write", 5, "1008h", "other", "--eds", "device.eds"), WRONG_USAGE,
                    stderr="edsc: 1008h:00 Manufacturer device name is const; not written (--force writes anyway)\n")
        self.assertEqual(self.network.frames("605"), [])

    def test_force_leaves_them_to_the_device(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 2005h:00 Maximum speed: refused by the device: 0609 0031h, value too high\n")
        self.expect(self.edsc("write", 5, "1008h", "x", "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 1008h:00 Manufacturer device name: refused by the device: 0601 0002h, write of a read-only object\n")

    def test_a_value_that_reads_back_as_another(self) -> None:
        self.expect(self.edsc("write", 5, "rounded_value", 15, "--eds", "device.eds", "--verify"), FAILED,
                    stderr="edsc: 2009h:00 Rounded value: written, but it reads back as 10 (000Ah)\n")

    def test_a_domain_from_a_file_by_block_transfer(self) -> None:
        content = bytes(i % 251 for i in range(5000))
        (self.folder / "firmware.bin").write_bytes(content)
        self.expect(self.edsc("write", 5, "firmware", "--file", "firmware.bin", "--eds", "device.eds"), FINE,
                    "2000h:00 Firmware: 5000 bytes from firmware.bin\n")
        self.edsc("read", 5, "log", "--eds", "device.eds", "--file", "back.bin")
        self.assertEqual((self.folder / "back.bin").read_bytes(), content)
        self.assertEqual(self.network.frames("605")[0], "605 C6 00 20 00 88 13 00 00")

    def test_a_file_without_an_eds_is_not_echoed(self) -> None:
        (self.folder / "firmware.bin").write_bytes(bytes(1000))
        self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin"), FINE, "2000h:00: 1000 bytes from firmware.bin\n")

    def test_by_segments_when_asked(self) -> None:
        (self.folder / "firmware.bin").write_bytes(bytes(range(200)))
        self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin", "--segmented"), FINE,
                    "2000h:00: 200 bytes from firmware.bin\n")
        self.expect(self.edsc("read", 5, "2001h", "--file", "back.bin", "--eds", "device.eds", "--segmented"), FINE,
                    "2001h:00 Log: 200 bytes to back.bin\n")
        self.assertEqual((self.folder / "back.bin").read_bytes(), bytes(range(200)))
        self.assertEqual([frame[:15] for frame in self.network.frames("605") if frame[7:15] in ("00 20 00", "01 20 00")],
                         ["605 21 00 20 00", "605 40 01 20 00"])

    def test_wrong_usage(self) -> None:
        for arguments, words in (
                (("1017h",), "VALUE or --file"),
                (("1017h", "5"), "requires a type"),
                (("1017h", "x", "--type", "u16"), "is not a number"),
                (("1017h", "70000", "--type", "u16"), "does not fit into UNSIGNED16"),
                (("1018h", "1", "--eds", "device.eds"), "1018h"),
                (("firmware", "--file", "missing", "--eds", "device.eds"), "missing: No such file"),
                (("firmware", "--file", ".", "--eds", "device.eds"), "edsc: .: Is a directory")):
            with self.subTest(arguments=arguments):
                result = self.edsc("write", 5, *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


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
node 5: 2 of 25 values differ; 2 of 2 values written, 2 verified, LEFT left out, 1020h written, stored
""".replace("LEFT", self.left_out))
        self.expect(self.edsc("read", 5, "2004h", "1017h", "1020h:01", "1020h:02", "--eds", "device.eds"), FINE, """\
2004h:00 Speed = 1200 rpm
1017h:00 Producer heartbeat time = 250 ms
1020h:01 Verify configuration, Configuration date = 00003C0Ch
1020h:02 Verify configuration, Configuration time = 031C8240h
""")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    f"node 5: 0 of 25 values differ, {self.left_out} left out\n")
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
                    f"node 5: 25 of 25 values written, 25 verified, {self.left_out} left out, 1020h written\n")

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
                         [(0x1A00, "2", "1"), (0x1A00, "60410010h", "60640020h"), (0x2004, "1000 rpm", "1200 rpm")])
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
        self.assertEqual([row["index"] for row in found["withheld"]], [0x2004])
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
            self.assertIn("edsc: node 5 restarted meanwhile: it may have lost what was written before", result.stderr)
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
                         [("switch off", 0x1005, None), ("switch on", 0x1005, "00000081h"),
                          ("write", 0x2004, "1200 rpm"), ("switch off", 0x1800, None)])
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
edsc: axis.dcf: 1 error; what is wrong is left out ("edsc check --keep-going" lists it)
axis.dcf:{mapping}:16: error: 1A00h:02 TPDO mapping parameter 1, Mapping entry 2 = 20020008h: refused by the device: 0604 0041h, object cannot be mapped to the PDO; the related entries are not changed
axis.dcf:{speed}:16: error: 2004h:00 Speed = 4000 rpm: refused by the device: 0609 0031h, value too high
axis.dcf:{rounded}:16: error: 2009h:00 Rounded value = 7: reads back as 0
""")
        self.expect(self.edsc("read", 5, "1800h:01", "--eds", "device.eds"), FINE,
                    "1800h:01 TPDO communication parameter 1, COB-ID used by TPDO = 80000185h\n")

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
        result = self.edsc("configure", 5, "axis.dcf", "--timeout", 5000)
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))

    def test_the_dcf_of_another_node(self) -> None:
        self.only(x2004="1200")
        for options in ((), ("--dry-run",), ("--dry-run", "--all")):
            result = subprocess.run([EDSC, "configure", "socketcan:none", "6", "axis.dcf", *options], cwd=self.folder,
                                    capture_output=True, text=True, timeout=600)
            self.expect(result, FAILED,
                        stderr="edsc: axis.dcf is for node 5, not for node 6 (--force writes anyway)\n")
        self.expect(self.edsc("configure", 6, "axis.dcf", "--timeout", 50, "--force"), FAILED,
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
        self.assertEqual(found["failures"], [{"index": 0x2004, "sub_index": 0, "name": "Speed", "line": line,
                                              "text": "refused by the device: 0609 0031h, value too high"}])


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
        self.assertRegex(result.stdout, r"^node 5: \d+ entries read, 4 values saved to axis.dcf, 2 left out \(process data\)\n$")
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
        self.assertRegex(result.stderr, r"^node 5: \d+ entries read, 0 values saved, 2 left out \(process data\)\n$")

    def test_all_values(self) -> None:
        found = self.expect_json(self.edsc("save", 5, "device.eds", "-o", "all.dcf", "--all", "--format", "json"),
                                 "save.schema.json")
        self.assertEqual(found["saved"] + len(found["process_data"]), found["read"])
        self.assertEqual([row["index"] for row in found["process_data"]], [0x6040, 0x60FF])
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
        self.expect(self.edsc("save", 9, "device.eds", "--timeout", 50), FAILED, stderr="edsc: node 9 does not answer\n")

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


class Record(LiveTest):
    nodes = ()

    def wait_until_it_records(self, process: subprocess.Popen[str]) -> None:
        """Sends frames until edsc record has written one."""
        client = self.network.client()
        while not select.select([process.stdout], [], [], 0.1)[0]:
            client.send("701 05")

    def test_it_writes_lines_of_candump(self) -> None:
        process = self.start("record", "--count", 5)
        self.wait_until_it_records(process)
        client = self.network.client()
        for frame in ("605 40 00 10 00 00 00 00 00", "080", "701 05", "701 05", "701 05"):
            client.send(frame)
        stdout, stderr = process.communicate(timeout=600)
        self.assertEqual((process.returncode, stderr), (FINE, ""))
        lines = stdout.splitlines()
        self.assertEqual(len(lines), 5)
        for line in lines:
            self.assertRegex(line, r"^\(\d{10}\.\d{6}\) vcan0 [0-9A-F]{3}#[0-9A-F]*$")
        times = [float(line[1:18]) for line in lines]
        self.assertEqual(times, sorted(times))

    def test_its_file_is_one_for_decode_and_can_utils(self) -> None:
        process = self.start("record", "-o", "bus.log", "--interface", "can7")
        client, log = self.network.client(), self.folder / "bus.log"
        while not log.exists() or not log.stat().st_size:
            client.send("605 40 00 10 00 00 00 00 00")
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=600)
        count = len(log.read_text().splitlines())
        self.assertEqual((stdout, stderr, process.returncode), (f"{count} frames written to bus.log\n", "", FINE))
        decoded = subprocess.run([EDSC, "decode", log], capture_output=True, text=True, timeout=60)
        self.assertEqual(decoded.returncode, FINE)
        self.assertEqual(len(decoded.stdout.splitlines()), count)
        if shutil.which("log2asc"):
            ascii_log = subprocess.run(["log2asc", "-I", log, "can7"], capture_output=True, text=True, timeout=60)
            self.assertEqual((ascii_log.returncode, ascii_log.stdout.count(" 605 ")), (0, count), ascii_log)

    def test_it_ends_after_its_time(self) -> None:
        self.expect(self.edsc("record", "--seconds", 0.05), FINE)

    def test_a_full_disk(self) -> None:
        process = self.start("record", "-o", "/dev/full")
        client = self.network.client()
        while process.poll() is None:
            client.send("701 05")
            time.sleep(0.05)
        self.assertEqual((process.returncode, process.stderr.read()),
                         (WRONG_USAGE, "edsc: /dev/full: No space left on device\n"))

    def test_the_bus_goes_away(self) -> None:
        process = self.start("record")
        self.wait_until_it_records(process)
        self.network.bus.kill()
        _, stderr = process.communicate(timeout=600)
        self.assertEqual(process.returncode, FAILED)
        self.assertIn(": the bus is lost: ", stderr)

    def test_wrong_usage(self) -> None:
        for arguments in (("--count", 0), ("--seconds", 0), ("--interface", "a b"), ("-o", "no/such/folder/log")):
            self.assertEqual(self.edsc("record", *arguments).returncode, WRONG_USAGE, arguments)


class Nmt(LiveTest):
    nodes = (5, 6)

    def test_commands(self) -> None:
        for command, node in (("start", "all"), ("stop", 5), ("pre-operational", 5), ("reset-communication", 6)):
            self.expect(self.edsc("nmt", command, node), FINE)
        self.assertEqual(self.network.frames("000"), ["000 01 00", "000 02 05", "000 80 05", "000 82 06"])

    def test_it_waits_for_the_boot_up_message(self) -> None:
        self.expect(self.edsc("nmt", "reset-node", 5, "--wait", 60_000), FINE)
        self.expect(self.edsc("nmt", "reset-node", 9, "--wait", 50), FAILED,
                    stderr="edsc: node 9 did not report boot-up within 50 ms: it has not sent a boot-up message\n")

    def test_it_says_why_no_heartbeat_may_come(self) -> None:
        self.expect(self.edsc("nmt", "start", 5, "--wait", 50), FAILED,
                    stderr="edsc: node 5 did not report operational within 50 ms: it has not sent a heartbeat; "
                           f"1017h may be 0 (edsc read {self.network.address} 5 1017h --type u16)\n")
        self.edsc("write", 6, "1017h", 10, "--type", "u16")
        self.expect(self.edsc("nmt", "stop", 6, "--wait", 60_000), FINE)
        self.network.device(lambda frame: ["707 7F"] if frame == "000 01 07" else [])
        self.expect(self.edsc("nmt", "start", 7, "--wait", 10_000), FAILED,
                    stderr="edsc: node 7 did not report operational within 10000 ms: the last state that it reported is "
                           "pre-operational\n")

    def test_wrong_usage(self) -> None:
        for arguments in (("start",), ("go", 5), ("start", 128), ("start", "all", "--wait", 10)):
            self.assertEqual(self.edsc("nmt", *arguments).returncode, WRONG_USAGE)


class Lss(LiveTest):
    nodes = (5, 255)
    address = ("--vendor", "0xABCDEF", "--product", "1001h", "--revision", "10002h", "--serial", "257")
    product = address[:6]
    shown = "vendor-ID 00ABCDEFh, product code 00001001h, revision 00010002h, serial number 00000101h"

    def lss(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        return self.edsc("lss", "--timeout", 2000, "--step", 200, *arguments)

    def test_assign_by_address(self) -> None:
        self.expect(self.lss("assign", *self.address, "--node-id", 7, "--store"), FINE,
                    self.shown + ": node-ID 7, stored\n")
        self.assertEqual(self.network.frames("7E5", "7E4"), [
            "7E5 04 00 00 00 00 00 00 00",
            "7E5 40 EF CD AB 00 00 00 00", "7E5 41 01 10 00 00 00 00 00",
            "7E5 42 02 00 01 00 00 00 00", "7E5 43 01 01 00 00 00 00 00", "7E4 44 00 00 00 00 00 00 00",
            "7E5 11 07 00 00 00 00 00 00", "7E4 11 00 00 00 00 00 00 00",
            "7E5 17 00 00 00 00 00 00 00", "7E4 17 00 00 00 00 00 00 00",
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
        found = self.expect_json(self.edsc("scan", "--nodes", 9, "--listen", 0, "--timeout", 2000, "--lss", "--step", 500, "--format", "json"),
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
        self.expect(self.lss("activate", "--delay", 20), FINE)
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
        words = ("edsc: fastscan: a device without node-ID answers LSS, but not Fastscan, which it may not support; with no "
                 "other device on the bus, \"edsc lss BUS state configuration\" and \"inquire\" show its numbers for "
                 "\"assign\"\n")
        self.expect(self.edsc("lss", "--timeout", 2000, "fastscan"), FAILED, stderr=words)
        self.expect(self.edsc("lss", "--timeout", 2000, "assign", "--node-id", 7), FAILED, stderr=words)


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
    numbers = ("--step", 500, "--timeout", 2000, "fastscan", "--vendor", "93h", "--product", 2, "--revision", 3)
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
                          ("scan", "--nodes", 9, "--listen", 0, "--timeout", 2000, "--lss", "--step", 500)):
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


class Monitor(LiveTest):
    nodes = (5, 6)

    def setUp(self) -> None:
        super().setUp()
        self.edsc("write", 5, "1017h", 40, "--type", "u16")

    def test_a_summary_as_json(self) -> None:
        self.edsc("write", 5, "1017h", 200, "--type", "u16")
        process = self.start("monitor", "--node", "5=device.eds", "--once", 15, "--bit-rate", 125, "--format", "json")
        time.sleep(4)  # until it receives frames
        self.edsc("nmt", "start", 5)
        client = self.network.client()
        client.send("086 30 81 11 00 00 00 00 00")
        client.send("123 01")
        stdout, stderr = process.communicate(timeout=600)
        found = self.expect_json(subprocess.CompletedProcess([], process.returncode, stdout, stderr), "monitor.schema.json")
        drive, other = found["nodes"]
        self.assertEqual((drive["node_id"], drive["name"], drive["state"], drive["late"]), (5, "Live device", "operational", False))
        self.assertGreater(drive["heartbeats"], 8)
        self.assertEqual((other["node_id"], other["emergencies"], other["last_emergency"]["code"]), (6, 1, 0x8130))
        self.assertEqual([(pdo["node_id"], pdo["direction"], pdo["number"], pdo["values"]) for pdo in found["pdos"]], [
            (5, "transmit", 1, [{"name": "Statusword", "text": found["pdos"][0]["values"][0]["text"]},
                                {"name": "Position actual value", "text": "123456 inc"}])])
        self.assertEqual([(other["cob_id"], other["frames"]) for other in found["others"]], [(0x123, 1)])
        self.assertGreater(found["load_percent"], 0)

    def test_a_summary_as_a_table(self) -> None:
        result = self.edsc("monitor", "--once", 3, "--node", "5=device.eds")
        lines = result.stdout.splitlines()
        self.assertRegex(lines[0], r"^socketcand:\S+  \d+\.\d s  \d+ frames  \d+\.\d per s$")
        self.assertEqual(lines[2], "node  name         state            heard  last EMCY")
        self.assertRegex(lines[3], r"^   5  Live device  pre-operational  \d\.\d s( late)?  -$")
        self.assertNotIn("\x1b", result.stdout)

    def test_a_line_for_each_change(self) -> None:
        self.edsc("write", 5, "1017h", 1000, "--type", "u16")
        process = self.start("monitor", "--node", "5=device.eds")
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  HEART     node 5 .*pre-operational")
        self.edsc("nmt", "start", 5)
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  NMT       node 5 .*start")
        rest = process.stdout.readline() + process.stdout.readline()
        self.assertIn("Position actual value = 123456 inc", rest)
        self.assertRegex(rest, r"(?<!pre-)operational")
        process.send_signal(signal.SIGINT)
        self.assertEqual((process.wait(timeout=600), process.stdout.read()), (FINE, ""))

    def test_the_table_on_a_terminal(self) -> None:
        terminal, inside = pty.openpty()
        self.addCleanup(os.close, terminal)
        resize = lambda rows, columns: fcntl.ioctl(inside, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        resize(10, 60)
        before = termios.tcgetattr(inside)
        process = subprocess.Popen(self.command("monitor", "--node", "5=device.eds"), cwd=self.folder, stdin=inside,
                                   stdout=inside, stderr=inside, env={**os.environ, "NO_COLOR": "1"})
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)

        def shown_until(wanted: str) -> str:
            shown, end = "", time.monotonic() + 120
            while wanted not in shown and time.monotonic() < end:
                if select.select([terminal], [], [], 0.1)[0]:
                    shown += os.read(terminal, 65536).decode()
            self.assertIn(wanted, shown)
            return shown

        shown = shown_until("pre-operational")
        self.assertTrue(shown.startswith("\x1b[?1049h\x1b[?25l\x1b[H"), repr(shown[:40]))
        for line in re.split(r"\r+\n|\x1b\[H", shown):
            self.assertLessEqual(len(re.sub(r"\x1b\[[^a-zA-Z]*[a-zA-Z]", "", line)), 60)
        self.assertNotEqual(termios.tcgetattr(inside)[3], before[3])
        resize(3, 40)
        shown_until("more lines")
        os.write(terminal, b"q")
        self.assertTrue(shown_until("\x1b[?1049l").endswith("\x1b[?25h\x1b[?1049l"))
        self.assertEqual(process.wait(timeout=600), FINE)
        self.assertEqual(termios.tcgetattr(inside), before)
        os.close(inside)

    def test_wrong_usage(self) -> None:
        for arguments in (("--node", "5"), ("--node", "0=device.eds"), ("--format", "json"), ("--once", 0),
                          ("--node", "5=missing.eds")):
            self.assertEqual(self.edsc("monitor", *arguments).returncode, WRONG_USAGE, arguments)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
