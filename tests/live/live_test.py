#!/usr/bin/env python3
"""edsc scan, read, write, configure, monitor, lss and nmt against live nodes on the virtual bus of `edsc bus`.

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

sys.path.insert(0, str(Path(__file__).parent))
from network import Network  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
LIVE_NODES = Path(sys.argv[3]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/live_device.eds"
FINE, FAILED, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130
ABORT_GENERAL = "605 80 17 10 00 00 00 00 08"


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
        return [str(EDSC), command, self.network.address, *map(str, arguments)]

    def edsc(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(self.command(command, *arguments), cwd=self.folder, capture_output=True, text=True,
                              timeout=60)

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
    fast = ("--timeout", 100, "--listen", 100)

    def test_it_tells_who_is_there(self) -> None:
        self.expect(self.edsc("scan", *self.fast), FINE, """\
node  state  vendor-ID  product    revision   serial     device type                                   name
   5  -      00ABCDEFh  00001001h  00010002h  00000100h  00020192h CiA 402, drives and motion control  Live device
   6  -      00ABCDEFh  00001001h  00010002h  00000101h  00020192h CiA 402, drives and motion control  Live device
""")

    def test_it_waits_for_a_heartbeat_that_it_knows_of(self) -> None:
        self.edsc("write", 6, "1017h", 300, "--type", "u16")
        self.edsc("nmt", "start", 6)
        found = self.expect_json(self.edsc("scan", *self.fast, "--format", "json"), "scan.schema.json")
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
        result = subprocess.run([EDSC, "scan", "can0"], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertTrue(result.stderr.startswith('edsc: "can0" is no bus'), result.stderr)


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
                    stderr='edsc: "speed" is no address such as 1018h:01; for names a data sheet is needed (--eds)\n')

    def test_what_the_device_refuses(self) -> None:
        self.expect(self.edsc("read", 5, "2FFFh", "6064h"), FAILED, "6064h:00 = 40 E2 01 00\n",
                    "edsc: 2FFFh:00: refused: 0602 0000h, object does not exist\n")
        self.expect(self.edsc("read", 5, "2006h"), FAILED,
                    stderr="edsc: 2006h:00: refused: 0601 0001h, read of a write-only object\n")

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
            "abort_code": 0x06020000, "text": "refused: 0602 0000h, object does not exist"}])

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
                (("200", "1000h"), "no node-ID"),
                (("5", "--all"), "--eds"),
                (("5", "1000h", "--eds", "missing.eds"), "missing.eds"),
                (("5", "speeed", "--eds", "device.eds"), "speed"),
                (("5", "1018h", "--eds", "device.eds", "--file", "x"), "one entry, not of 5")):
            with self.subTest(arguments=arguments):
                result = self.edsc("read", *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


class Silence(LiveTest):
    """Devices and buses that fall silent."""
    nodes = ()

    def wait_for(self, process: subprocess.Popen[str]) -> tuple[int, str, str]:
        return process.wait(timeout=60), process.stdout.read(), process.stderr.read()

    def test_ctrl_c_aborts_the_transfer(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", 10_000)
        self.assertEqual(asked.receive(), "605 40 17 10 00 00 00 00 00")
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.wait_for(process), (INTERRUPTED, "", "edsc: interrupted\n"))
        self.assertEqual(self.network.frames(), ["605 40 17 10 00 00 00 00 00", ABORT_GENERAL])

    def test_the_bus_goes_away(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", 10_000)
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
                    stderr="edsc: 1008h:00: the transfer broke: 0503 0000h, toggle bit not alternated\n")

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

    def test_block_transfer_falls_back_to_segments(self) -> None:
        segments = {"605 40 01 20 00 00 00 00 00": ["585 41 01 20 00 09 00 00 00"],
                    "605 60 00 00 00 00 00 00 00": ["585 00 01 02 03 04 05 06 07"],
                    "605 70 00 00 00 00 00 00 00": ["585 1B 08 09 00 00 00 00 00"]}
        refusal = {"605 A4 01 20 00 7F 1C 00 00": ["585 80 01 20 00 01 00 04 05"]}
        for name, answers in (("refused", segments | refusal), ("no answer", segments)):
            with self.subTest(name), Network(EDSC, LIVE_NODES) as network:
                self.network = network
                network.device(lambda frame, known=answers: known.get(frame, []))
                self.expect(self.edsc("read", 5, "log", "--eds", "device.eds", "--timeout", 100), FINE,
                            "2001h:00 Log = 01 02 03 04 05 06 07 08 09 (9 bytes)\n")


class Write(LiveTest):
    def test_with_the_unit_and_read_back(self) -> None:
        self.expect(self.edsc("write", 5, "speed", "1500 rpm", "--eds", "device.eds", "--verify"), FINE,
                    "2004h:00 Speed = 1500 rpm, verified\n")
        self.expect(self.edsc("write", 5, "label", "left axis", "--eds", "device.eds"), FINE, '2002h:00 Label = "left axis"\n')
        self.expect(self.edsc("read", 5, "label", "speed", "--eds", "device.eds"), FINE,
                    '2002h:00 Label = "left axis"\n2004h:00 Speed = 1500 rpm\n')

    def test_without_a_data_sheet(self) -> None:
        self.expect(self.edsc("write", 5, "1017h", "500", "--type", "u16"), FINE, "1017h:00 = 500 (01F4h)\n")
        self.expect(self.edsc("write", 5, "1017h", "--raw", "F4", "01"), FINE, "1017h:00 = F4 01\n")
        self.assertEqual(self.network.frames("605"), ["605 2B 17 10 00 F4 01 00 00"] * 2)

    def test_limits_are_looked_at_first(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds"), WRONG_USAGE,
                    stderr='edsc: 6001 is above the high limit of 2005h:00 "Maximum speed", 6000\n')
        self.expect(self.edsc("write", 5, "1008h", "other", "--eds", "device.eds"), WRONG_USAGE,
                    stderr="edsc: 1008h:00 Manufacturer device name is const: it is not written (--force tries)\n")
        self.assertEqual(self.network.frames("605"), [])

    def test_force_leaves_them_to_the_device(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 2005h:00 Maximum speed: refused: 0609 0031h, value too high\n")
        self.expect(self.edsc("write", 5, "1008h", "x", "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 1008h:00 Manufacturer device name: refused: 0601 0002h, write of a read-only object\n")

    def test_a_value_that_reads_back_as_another(self) -> None:
        self.expect(self.edsc("write", 5, "rounded_value", 15, "--eds", "device.eds", "--verify"), FAILED,
                    stderr="edsc: 2009h:00 Rounded value: written, but it reads back as 10 (000Ah)\n")

    def test_a_domain_from_a_file_by_block_transfer(self) -> None:
        content = bytes(i % 251 for i in range(5000))
        (self.folder / "firmware.bin").write_bytes(content)
        self.expect(self.edsc("write", 5, "firmware", "--file", "firmware.bin", "--eds", "device.eds"), FINE,
                    "2000h:00 Firmware = " + content[:32].hex(" ").upper() + " ... (5000 bytes)\n")
        self.edsc("read", 5, "log", "--eds", "device.eds", "--file", "back.bin")
        self.assertEqual((self.folder / "back.bin").read_bytes(), content)
        self.assertEqual(self.network.frames("605")[0], "605 C6 00 20 00 88 13 00 00")

    def test_wrong_usage(self) -> None:
        for arguments, words in (
                (("1017h",), "VALUE or --file"),
                (("1017h", "5"), "needs a type"),
                (("1017h", "x", "--type", "u16"), "is no number"),
                (("1017h", "70000", "--type", "u16"), "does not fit into UNSIGNED16"),
                (("1018h", "1", "--eds", "device.eds"), "1018h"),
                (("firmware", "--file", "missing", "--eds", "device.eds"), "missing: No such file")):
            with self.subTest(arguments=arguments):
                result = self.edsc("write", 5, *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


class Configure(LiveTest):
    def dcf(self, **values: str) -> Path:
        """The DCF of node 5 with these ParameterValues: `x2004="1200"`."""
        path = self.folder / "axis.dcf"
        subprocess.run([EDSC, "format", SHEET, "--dcf", "--node-id", "5", "-o", path], check=True)
        text = path.read_text()
        for section, value in values.items():
            pattern = rf"(\[{section[1:]}\][^\[]*?ParameterValue=)[^\n]*"
            text, count = re.subn(pattern, rf"\g<1>{value}", text, flags=re.IGNORECASE)
            self.assertEqual(count, 1, section)
        path.write_text(text)
        return path

    def only(self, **values: str) -> Path:
        """The same with no other ParameterValue."""
        path = self.dcf(**values)
        kept, section = [], ""
        for line in path.read_text().splitlines():
            section = line[1:-1].lower() if line.startswith("[") else section
            if not line.startswith("ParameterValue") or "x" + section in (name.lower() for name in values):
                kept.append(line)
        path.write_text("\n".join(kept) + "\n")
        return path

    def test_all_values_and_again_nothing(self) -> None:
        self.dcf(x2004="1200", x1017="250")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--store"), FINE,
                    "node 5: 25 of 25 values written, 25 verified, 4 left out, 1020h written, stored\n")
        self.expect(self.edsc("read", 5, "2004h", "1017h", "1020h:01", "1020h:02", "--eds", "device.eds"), FINE, """\
2004h:00 Speed = 1200 rpm
1017h:00 Producer heartbeat time = 250 ms
1020h:01 Verify configuration, Configuration date = 00003C0Ch
1020h:02 Verify configuration, Configuration time = 031C8240h
""")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "node 5: configured already, as 1020h says; nothing written\n")
        self.assertIn("605 23 10 10 01 73 61 76 65", self.network.frames())

    def test_a_pdo_goes_off_before_its_mapping_changes(self) -> None:
        self.only(x1A00sub0="1", x1A00sub1="0x60640020", x1800sub1="0x40000185", x1800sub5="100")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--start"), FINE,
                    "node 5: 4 of 4 values written, 4 verified, 1020h written\n")
        frames = self.network.frames("000", "605")
        self.assertEqual(frames[0], "000 80 05")
        self.assertEqual(frames[-1], "000 01 05")
        self.assertEqual([frame for frame in frames if frame[4] == "2" and frame[7:12] != "20 10"], [
            "605 23 00 18 01 85 01 00 80",
            "605 2F 00 1A 00 00 00 00 00",
            "605 23 00 1A 01 20 00 64 60",
            "605 2F 00 1A 00 01 00 00 00",
            "605 2B 00 18 05 64 00 00 00",
            "605 23 00 18 01 85 01 00 40",
        ])

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
        result = subprocess.run([EDSC, "configure", "socketcan:none", "5", "axis.dcf", "--dry-run"], cwd=self.folder,
                                capture_output=True, text=True, timeout=60)
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

    def test_values_that_wait_for_others_are_tried_again(self) -> None:
        self.only(x2004="4000", x2005="5000")
        self.expect(self.edsc("configure", 5, "axis.dcf"), FINE,
                    "node 5: 2 of 2 values written, 2 verified, 1020h written\n")
        written = [frame for frame in self.network.frames("605") if frame[4] == "2" and frame[7:12] != "20 10"]
        self.assertEqual(written, ["605 2B 04 20 00 A0 0F 00 00", "605 2B 05 20 00 88 13 00 00",
                                   "605 2B 04 20 00 A0 0F 00 00"])

    def test_what_is_refused_is_named_with_its_line(self) -> None:
        path = self.only(x2004="4000", x1A00sub0="2", x1A00sub1="0x60640020", x1A00sub2="0x20020008", x2009="7")
        lines = path.read_text().splitlines()
        speed, mapping, rounded = (next(i for i, line in enumerate(lines, 1) if line == f"ParameterValue={value}")
                                   for value in ("4000", "0x20020008", "7"))
        self.expect(self.edsc("configure", 5, "axis.dcf", "--store"), FAILED,
                    "node 5: 2 of 5 values written, 1 verified, 3 failed\n", f"""\
axis.dcf:{mapping}:16: error: 1A00h:02 TPDO mapping parameter 1, Mapping entry 2 = 20020008h: refused: 0604 0041h, object cannot be mapped to the PDO; what belongs to it is left as it is now
axis.dcf:{speed}:16: error: 2004h:00 Speed = 4000 rpm: refused: 0609 0031h, value too high
axis.dcf:{rounded}:16: error: 2009h:00 Rounded value = 7: reads back as 0
""")
        self.expect(self.edsc("read", 5, "1800h:01", "--eds", "device.eds"), FINE,
                    "1800h:01 TPDO communication parameter 1, COB-ID used by TPDO = 80000185h\n")

    def test_another_device(self) -> None:
        path = self.only(x2004="1200")
        path.write_text(path.read_text().replace("0x00001001", "0x00001002"))
        self.expect(self.edsc("configure", 5, "axis.dcf"), FAILED,
                    stderr="edsc: node 5 is not the device of axis.dcf: product code is 00001001h, not 00001002h "
                           "(--force writes nevertheless)\n")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--force"), FINE,
                    "node 5: 1 of 1 values written, 1 verified, 1020h written\n")

    def test_the_dcf_of_another_node(self) -> None:
        self.only(x2004="1200")
        self.expect(self.edsc("configure", 6, "axis.dcf", "--timeout", 50), FAILED, stderr="edsc: node 6 does not answer\n")
        path = self.folder / "axis.dcf"
        path.write_text(path.read_text().replace("NodeID=5", "NodeID=7").replace("NodeId=5", "NodeId=7"))
        self.expect(self.edsc("configure", 5, "axis.dcf"), FAILED,
                    stderr="edsc: axis.dcf is for node 7, not for node 5 (--force writes nevertheless)\n")

    def test_a_concise_dcf(self) -> None:
        self.only(x2004="1200", x1017="250")
        subprocess.run([EDSC, "format", "axis.dcf", "--concise", "-o", "axis.bin"], cwd=self.folder, check=True)
        self.expect(self.edsc("configure", 5, "axis.bin", "--concise"), FINE,
                    "node 5: 2 of 2 values written, 2 verified\n")
        self.expect(self.edsc("configure", 5, "axis.dcf", "--concise"), WRONG_USAGE,
                    stderr="edsc: axis.dcf is no concise DCF: it is shorter or longer than it says\n")
        self.expect(self.edsc("configure", 5, "device.eds"), WRONG_USAGE,
                    stderr='edsc: device.eds is no DCF: "edsc format --dcf" makes one of a data sheet\n')

    def test_as_json(self) -> None:
        path = self.only(x2004="4000")
        line = path.read_text().splitlines().index("ParameterValue=4000") + 1
        found = self.expect_json(self.edsc("configure", 5, "axis.dcf", "--format", "json"), "configure.schema.json", FAILED)
        self.assertEqual(found["failures"], [{"index": 0x2004, "sub_index": 0, "name": "Speed", "line": line,
                                              "text": "refused: 0609 0031h, value too high"}])


class Nmt(LiveTest):
    nodes = (5, 6)

    def test_commands(self) -> None:
        for command, node in (("start", "all"), ("stop", 5), ("pre-operational", 5), ("reset-communication", 6)):
            self.expect(self.edsc("nmt", command, node), FINE)
        self.assertEqual(self.network.frames("000"), ["000 01 00", "000 02 05", "000 80 05", "000 82 06"])

    def test_it_waits_for_the_boot_up_message(self) -> None:
        self.expect(self.edsc("nmt", "reset-node", 5, "--wait", 5000), FINE)
        self.expect(self.edsc("nmt", "reset-node", 9, "--wait", 50), FAILED,
                    stderr="edsc: node 9 does not tell within 50 ms that it is in boot-up\n")

    def test_wrong_usage(self) -> None:
        for arguments in (("start",), ("go", 5), ("start", 128), ("start", "all", "--wait", 10)):
            self.assertEqual(self.edsc("nmt", *arguments).returncode, WRONG_USAGE)


class Lss(LiveTest):
    nodes = (5, 255)
    address = ("--vendor", "0xABCDEF", "--product", "1001h", "--revision", "10002h", "--serial", "257")
    product = address[:6]
    shown = "vendor-ID 00ABCDEFh, product code 00001001h, revision 00010002h, serial number 00000101h"

    def lss(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        return self.edsc("lss", *arguments)

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
        found = self.expect_json(self.edsc("scan", "--nodes", 9, "--listen", 0, "--timeout", 20, "--lss", "--format", "json"),
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


class Monitor(LiveTest):
    nodes = (5, 6)

    def setUp(self) -> None:
        super().setUp()
        self.edsc("write", 5, "1017h", 40, "--type", "u16")

    def test_a_summary_as_json(self) -> None:
        process = self.start("monitor", "--node", "5=device.eds", "--once", 0.6, "--bit-rate", 500, "--format", "json")
        time.sleep(0.2)
        self.edsc("nmt", "start", 5)
        client = self.network.client()
        client.send("086 30 81 11 00 00 00 00 00")
        client.send("123 01")
        stdout, stderr = process.communicate(timeout=60)
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
        result = self.edsc("monitor", "--once", 0.2, "--node", "5=device.eds")
        lines = result.stdout.splitlines()
        self.assertRegex(lines[0], r"^socketcand:\S+  0\.2 s  \d+ frames  \d+\.\d per s$")
        self.assertEqual(lines[2], "node  name         state            heard  last EMCY")
        self.assertRegex(lines[3], r"^   5  Live device  pre-operational  0\.0 s  -$")
        self.assertNotIn("\x1b", result.stdout)

    def test_a_line_for_each_change(self) -> None:
        process = self.start("monitor", "--node", "5=device.eds")
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  HEART     node 5 .*pre-operational")
        self.edsc("nmt", "start", 5)
        self.assertRegex(process.stdout.readline(), r"^ +\d+\.\d{6}  NMT       node 5 .*start")
        rest = process.stdout.readline() + process.stdout.readline()
        self.assertIn("Position actual value = 123456 inc", rest)
        self.assertIn("operational", rest)
        process.send_signal(signal.SIGINT)
        self.assertEqual((process.wait(timeout=60), process.stdout.read()), (FINE, ""))

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
            shown, end = "", time.monotonic() + 5
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
        self.assertEqual(process.wait(timeout=60), FINE)
        self.assertEqual(termios.tcgetattr(inside), before)
        os.close(inside)

    def test_wrong_usage(self) -> None:
        for arguments in (("--node", "5"), ("--node", "0=device.eds"), ("--format", "json"), ("--once", 0),
                          ("--node", "5=missing.eds")):
            self.assertEqual(self.edsc("monitor", *arguments).returncode, WRONG_USAGE, arguments)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
