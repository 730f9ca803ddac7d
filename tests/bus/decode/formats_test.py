#!/usr/bin/env python3
"""The same frames in the formats of other programs decode to the same text; damaged captures; input in a stream.

    formats_test.py SOURCE_DIR EDSC
"""

from __future__ import annotations

import csv
import gzip
import io
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import log_frames  # noqa: E402
from log_frames import Frame  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
AXIS = SOURCE_DIR / "tests/bus/decode/axis.dcf"
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2


def edsc(*arguments: str | Path, log: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([EDSC, "decode", "--color", "never", "--node", AXIS, *arguments], input=log, capture_output=True,
                          timeout=600, check=False)


def without_interface(text: str) -> list[str]:
    return [" ".join(line.split(" ")[:1] + line.split(" ")[2:]) for line in text.splitlines()]


def candump_text(one: Frame) -> str:
    return f"{one.can_id:0{8 if one.extended else 3}X}#{one.data.hex().upper()}"


class Formats(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def text(self, path: Path, *arguments: str) -> str:
        result = edsc(path, *arguments)
        self.assertEqual(result.returncode, FINE, result.stderr)
        return result.stdout.decode()

    def same(self, log: list[Frame], write: Callable[[Path, list[Frame]], None], has_interface: bool) -> None:
        """The foreign log, and that of candump."""
        reference, foreign = self.folder / "reference.log", self.folder / "foreign"
        log_frames.candump(reference, log)
        write(foreign, log)
        wanted = self.text(reference).splitlines()
        self.assertEqual(len(wanted), len(log))
        self.assertEqual(wanted if has_interface else without_interface("\n".join(wanted)), self.text(foreign).splitlines())
        self.assertEqual(self.text(foreign), edsc("-", log=foreign.read_bytes()).stdout.decode())

    def test_asc_of_python_can(self) -> None:
        for seed in range(5):
            log = log_frames.frames(200, seed)
            log.append(Frame(log[-1].time_us + 100, 0x706, remote=True))
            with self.subTest(seed=seed):
                self.same(log, log_frames.python_can_asc, True)

    def test_asc_of_can_utils(self) -> None:
        for seed in range(5):
            with self.subTest(seed=seed):
                self.same(log_frames.frames(200, seed), log_frames.log2asc, True)
                self.same(log_frames.frames(200, seed), lambda path, frames: log_frames.log2asc(path, frames, "-f"), True)

    def test_trc_of_python_can(self) -> None:
        for seed in range(5):
            log = log_frames.frames(200, seed)
            with self.subTest(seed=seed):
                self.same(log, lambda path, frames: log_frames.python_can_trc(path, frames, "V2_1"), True)
            for number, one in enumerate(log):
                one.time_us = number * 1000
            with self.subTest(seed=seed, version="1.0"):
                self.same(log, lambda path, frames: log_frames.python_can_trc(path, frames, "V1_0"), False)

    def test_blf_of_python_can(self) -> None:
        for compression in (0, 1, 9):
            log = log_frames.frames(400, compression)
            log.append(Frame(log[-1].time_us + 100, 0x706, remote=True))
            with self.subTest(compression=compression):
                self.same(log, lambda path, frames, level=compression: log_frames.python_can_blf(path, frames, level), True)

    def test_a_damaged_blf(self) -> None:
        path = self.folder / "a.blf"
        log_frames.python_can_blf(path, log_frames.frames(400, 1), 9)
        whole = path.read_bytes()
        length = struct.unpack_from("<I", whole, 4)[0]
        for name, log, frames, problem in (
                ("header", whole[:60], 0, "the file header is not complete"),
                ("cut", whole[:-200], 1, "the log ends in an object"),
                ("mark", whole[:length] + b"XOBJ" + whole[length + 4:], 0, "no object where one is expected"),
                ("length", whole[:length + 8] + bytes(4) + whole[length + 12:], 0, "an object has an impossible length"),
                ("method", whole[:length + 16] + b"\7" + whole[length + 17:], 0, "compression method 7 is not known"),
                ("zlib", whole[:length + 40] + b"\xFF" * 8 + whole[length + 48:], 0, "not a complete zlib stream")):
            with self.subTest(name):
                result = edsc(log=log)
                self.assertNotEqual(result.returncode, FINE)
                self.assertIn(problem, result.stderr.decode())
                self.assertEqual(result.stdout != b"", bool(frames))

    def test_logs_of_busmaster(self) -> None:
        for mode in ("SYSTEM", "ABSOLUTE", "RELATIVE"):
            for decimal in (False, True):
                log = log_frames.frames(200, 12)
                log.append(Frame(log[-1].time_us + 100, 0x706, remote=True))
                with self.subTest(mode=mode, decimal=decimal):
                    self.same(log, lambda path, frames, mode=mode, decimal=decimal: log_frames.busmaster(path, frames, mode, decimal), True)

    def test_a_log_of_busmaster_over_midnight(self) -> None:
        log = (b"***BUSMASTER Ver 3.2.2***\n***HEX***\n***SYSTEM MODE***\n23:59:59:9999 Rx 1 0x706 s 1 05\n00:00:00:0009 Tx 1 0x706 s 1 05\n"
               b"00:00:01:0000 Rx 1 0x706 s-fd 1 05\n00:00:01:0000 Rx 1 0x706 q 1 05\n00:00:01 Rx 1 0x706 s 1 05\n00:00:02:0000 Rx 1 0x806 s 1 05\n")
        result = edsc(log=log)
        self.assertEqual([line.split(" ", 1)[0] for line in result.stdout.decode().splitlines()], ["86399.999900", "86400.000900"])
        self.assertEqual(result.stderr.decode().splitlines(), [
            "<stdin>:6: a CAN FD frame is ignored",
            '<stdin>:7: skipped, the type is not s, x, sr or xr: "00:00:01:0000 Rx 1 0x706 q 1 05"',
            '<stdin>:8: skipped, the time is not hours, minutes, seconds and units of 100 us: "00:00:01 Rx 1 0x706 s 1 05"',
            '<stdin>:9: skipped, the CAN-ID is not a number of 11 bits, or 29 bits with x: "00:00:02:0000 Rx 1 0x806 s 1 05"'])

    def test_logs_of_savvycan(self) -> None:
        for with_direction in (True, False):
            with self.subTest(with_direction=with_direction):
                self.same(log_frames.frames(200, 13), lambda path, frames, it=with_direction: log_frames.savvycan(path, frames, it), True)
        header = b"Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
        result = edsc(log=header + b"1,00000706,false,Rx,0,2,05,\n2,00000806,false,Rx,0,0,\n3.5,00000706,false,Rx,0,0,\n4,706,false,Rx,0,64,05,\n")
        self.assertEqual(result.stderr.decode().splitlines(), [
            '<stdin>:2: skipped, fewer bytes than the length states: "1,00000706,false,Rx,0,2,05,"',
            '<stdin>:3: skipped, the CAN-ID has more than 11 bits, and Extended is not true: "2,00000806,false,Rx,0,0,"',
            '<stdin>:4: skipped, the time is not a number of microseconds: "3.5,00000706,false,Rx,0,0,"',
            "<stdin>:5: a CAN FD frame is ignored"])

    def test_captures_of_scapy(self) -> None:
        for writer in ("RawPcapWriter", "RawPcapNgWriter"):
            for seed in range(3):
                with self.subTest(seed=seed, writer=writer):
                    self.same(log_frames.frames(200, seed),
                              lambda path, frames, writer=writer: log_frames.scapy_capture(path, frames, writer), False)

    def test_captures_of_all_byte_orders_and_resolutions(self) -> None:
        log = log_frames.frames(200, 7)
        log.append(Frame(log[-1].time_us + 100, 0x706, remote=True))
        for order in "<>":
            for name, capture in (("pcap", log_frames.pcap(log, order)), ("nanoseconds", log_frames.pcap(log, order, True)),
                                  ("pcapng", log_frames.pcapng(log, order)), ("ns pcapng", log_frames.pcapng(log, order, 9)),
                                  ("2^-30 s", log_frames.pcapng(log, order, 0x80 | 30))):
                with self.subTest(order=order, name=name):
                    self.same(log, lambda path, _, capture=capture: path.write_bytes(capture) and None, False)

    def test_a_forced_format(self) -> None:
        log = b"1.000000 1 706 Rx d 1 05\n"  # without a header
        self.assertIn(b"1.000000 1 706 05", edsc("--log-format", "asc", log=log).stdout)
        self.assertEqual(edsc(log=log).returncode, INPUT_HAS_ERRORS)
        refused = edsc("--log-format", "pcap", log=log)
        self.assertEqual(refused.returncode, WRONG_USAGE)
        self.assertRegex(refused.stderr, rb"not a log of format pcap: byte \d+: ")

    def test_a_link_type_that_is_not_can(self) -> None:
        for capture in (log_frames.pcap([], link_type=1), log_frames.pcapng([], link_type=1)):
            refused = edsc(log=capture)
            self.assertEqual(refused.returncode, WRONG_USAGE)
            self.assertIn(b"the link type is EN10MB, not CAN_SOCKETCAN (227)", refused.stderr)

    def test_interfaces_of_a_capture(self) -> None:
        """Packets of Ethernet are skipped, whatever their place; each section has interfaces of its own."""
        log = log_frames.frames(60, 3)
        ethernet = log_frames.pcapng_packet(0, 5, bytes(60))
        capture = log_frames.pcapng_section() + log_frames.pcapng_interface("eth0", 1) + ethernet
        capture += log_frames.pcapng_interface("can0") + log_frames.pcapng_interface("can1")
        capture += log_frames.pcapng_block("<", 4, bytes(200_000))  # names of hosts: a block to skip
        for number, one in enumerate(log[:40]):
            capture += ethernet + log_frames.pcapng_packet(1 + number % 2, one.time_us, one.packet)
        capture += log_frames.pcapng_section(">") + log_frames.pcapng_interface("can1", order=">", offset=-2)
        for one in log[40:]:
            capture += log_frames.pcapng_packet(0, one.time_us + 2_000_000, one.packet, ">")
        path, reference = self.folder / "a.pcapng", self.folder / "reference.log"
        path.write_bytes(capture)
        names = ["can0" if number < 40 and number % 2 == 0 else "can1" for number in range(60)]
        reference.write_text("".join(f"({one.seconds}) {name} {candump_text(one)}\n" for name, one in zip(names, log)))
        self.assertEqual(self.text(path), self.text(reference))
        for name in ("can0", "can1"):
            self.assertEqual(self.text(path, "--interface", name), self.text(reference, "--interface", name))
            self.assertEqual(self.text(path, "--interface", name).count("\n"), names.count(name))
        self.assertEqual(self.text(path, "--interface", "can9"), "")

    def test_interfaces_without_a_name_have_their_number(self) -> None:
        one = Frame(0, 0x706, b"\x05")
        capture = log_frames.pcapng_section() + log_frames.pcapng_interface("") * 2
        capture += log_frames.pcapng_packet(1, 0, one.packet)
        self.assertEqual(edsc("--interface", "1", log=capture).stdout.count(b"\n"), 1)
        self.assertEqual(edsc("--interface", "0", log=capture).stdout, b"")

    def test_captures_of_all_interfaces_of_linux(self) -> None:
        log = log_frames.frames(200, 9)
        for order in "<>":
            for second in (False, True):
                with self.subTest(order=order, second=second):
                    capture = log_frames.pcap([], order, link_type=276 if second else 113)
                    ethernet = log_frames.cooked(log[0], order, hardware=1, second=second)
                    for one in log:
                        for packet in (ethernet, log_frames.cooked(one, order, second=second)):
                            capture += struct.pack(order + "IIII", 0, one.time_us, len(packet), len(packet)) + packet
                    self.same(log, lambda path, _, capture=capture: path.write_bytes(capture) and None, False)

    def test_older_packets_of_pcapng(self) -> None:
        """Simple packets, which have no time, and those that are obsolete."""
        one = Frame(0, 0x706, b"\x05")
        start = log_frames.pcapng_section() + log_frames.pcapng_interface("")
        simple = log_frames.pcapng_block("<", 3, struct.pack("<I", len(one.packet)) + one.packet)
        self.assertIn(b"706 05 ", edsc(log=start + simple).stdout)
        old = log_frames.pcapng_block("<", 2, struct.pack("<HHIIII", 0, 0, 0, 1_500_000, len(one.packet), 9) + one.packet)
        self.assertIn(b"1.500000 706 05 ", edsc(log=start + old).stdout)

    def test_damaged_captures(self) -> None:
        one = Frame(0, 0x706, b"\x05")
        start, packet = log_frames.pcapng_section() + log_frames.pcapng_interface("can0"), one.packet
        good = log_frames.pcapng_packet(0, 0, packet)
        for name, block, problem in (
                ("interface", log_frames.pcapng_packet(7, 0, packet), "a packet of interface 7, which is unknown"),
                ("length", good[:20] + struct.pack("<I", 400) + good[24:], "a packet that is longer than its block"),
                ("trailer", good[:-4] + bytes(4), "the two lengths of a block differ"),
                ("short", struct.pack("<II", 6, 8), "a block of 8 bytes"), ("odd", struct.pack("<II", 6, 33), "a block of 33 bytes"),
                ("large", struct.pack("<II", 6, 1 << 31), "a block of 2147483648 bytes"), ("cut", good[:30], "ends within a packet"),
                ("cut header", good[:6], "ends within the header of a block"), ("order", good[:0] + log_frames.pcapng_section()[:8] + bytes(20), "a section without byte order")):
            with self.subTest(name):
                result = edsc(log=start + good + block)
                self.assertEqual((result.returncode, result.stdout.count(b"\n")), (INPUT_HAS_ERRORS, 1), result.stderr)
                self.assertIn(problem, result.stderr.decode())

    def test_files_that_must_be_converted_before(self) -> None:
        line = "(1.000000) can0 706#05\n"
        for name, log in (("gzip", gzip.compress(line.encode())), ("UTF-16", line.encode("utf-16")),
                          ("UTF-16", b"\xFE\xFF" + line.encode("utf-16-be")), ("MDF", b"MDF     4.10    "), ("Parquet", b"PAR1\x15"), ("IXXAT", b"ASCII Trace IXXAT ID-2\n"),
                          ("Kvaser", b"Chn Identifier Flg   DLC  D0...1...2...3...4...5...6..D7       Time     Dir\n"),
                          ("data sheet", AXIS.read_bytes()), ("XDD", b'<?xml version="1.0"?>\n<ISO15745ProfileContainer>')):
            with self.subTest(name):
                refused = edsc(log=log)
                self.assertEqual((refused.returncode, refused.stdout), (WRONG_USAGE, b""))
                self.assertRegex(refused.stderr.decode(), f"^edsc: <stdin>: .*{name}.*\n$")

    def test_a_truncated_capture(self) -> None:
        log = [Frame(0, 0x706, b"\x05"), Frame(100, 0x706, b"\x05")]
        for capture, end in ((log_frames.pcap(log), 24 + 16 + 9), (log_frames.pcapng(log), 28 + 20 + 44)):
            with self.subTest(length=len(capture)):
                cut = edsc(log=capture[:-3])
                self.assertEqual(cut.returncode, INPUT_HAS_ERRORS)
                self.assertEqual(cut.stdout.decode().splitlines(),
                                 ["0.000000 706 05                      HEART    node 6 axis-y operational"])
                self.assertIn(f"<stdin>: packet 2 at byte {end}: the rest cannot be read: ", cut.stderr.decode())

    def test_packets_that_are_not_frames(self) -> None:
        """Too short, too long, CAN FD, an error frame and a good one: 16 bytes of packet header, 24 of the file."""
        packets = [b"\0\0\7\6\1", struct.pack(">IB3x", 0x706, 9) + bytes(8), struct.pack(">IB3x", 0x706, 8) + bytes(4),
                   struct.pack(">IB3x", 0x706, 16) + bytes(64), struct.pack(">IBBxx", 0x706, 1, 4) + b"\5",
                   struct.pack(">IB3x", log_frames.ERROR | 4, 8) + bytes.fromhex("0008000000000000"),
                   struct.pack(">IB3x", 0x706, 1) + b"\5"]
        capture = log_frames.pcap([])
        for packet in packets:
            capture += struct.pack("<IIII", 1, 0, len(packet), len(packet)) + packet
        result = edsc(log=capture)
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertEqual(result.stderr.decode().splitlines(), [
            "<stdin>: packet 1 at byte 24: skipped, the packet is shorter than the header of a frame",
            "<stdin>: packet 2 at byte 45: skipped, the length is not 0 to 8",
            "<stdin>: packet 3 at byte 77: skipped, fewer bytes than the length states",
            "<stdin>: packet 4 at byte 105: a CAN FD frame is ignored",
            "<stdin>: packet 5 at byte 193: a CAN FD frame is ignored"])
        lines = result.stdout.decode().splitlines()
        self.assertEqual(len(lines), 2)
        self.assertIn("controller (warning level of transmit errors)", lines[0])
        self.assertIn("operational", lines[1])

    def test_frames_of_a_pipe_are_decoded_at_once(self) -> None:
        log = [Frame(0, 0x706, b"\x05"), Frame(100, 0x706, b"\x7F")]
        asc = b"base hex timestamps absolute\n0.0 1 706 Rx d 1 05\n"
        for name, first, second in (("pcap", log_frames.pcap(log[:1]), log_frames.pcap(log)[49:]),
                                    ("pcapng", log_frames.pcapng(log[:1]), log_frames.pcapng(log)[92:]),
                                    ("asc", asc, b"0.1 1 706 Rx d 1 7F\n")):
            with self.subTest(format=name), subprocess.Popen([EDSC, "decode", "-"], stdin=subprocess.PIPE,
                                                             stdout=subprocess.PIPE) as program:
                os.write(program.stdin.fileno(), first)
                self.assertIn(b"operational", program.stdout.readline())  # while the pipe is open
                os.write(program.stdin.fileno(), second)
                self.assertIn(b"pre-operational", program.stdout.readline())
                program.stdin.close()
                self.assertEqual(program.wait(timeout=600), FINE)

    def test_csv_has_the_values_of_json(self) -> None:
        path = self.folder / "log"
        log_frames.candump(path, log_frames.frames(300, 11))
        text = edsc(path, "--format", "csv").stdout.decode()
        self.assertEqual(text.count("\n"), text.count("\r\n"))  # RFC 4180, 2.1
        rows = list(csv.DictReader(io.StringIO(text, newline=""), strict=True))
        records = iter(rows)
        for line in edsc(path, "--format", "json").stdout.decode().splitlines():
            one = json.loads(line)
            for value in one.get("values", [None]):
                row = next(records)
                text = one["text"] if value is None else value["text"]
                self.assertEqual((row["line"], round(float(row["time"]) * 1e6), row["bus"], row["data"], row["service"], row["text"]),
                                 (str(one["line"]), one["time_us"], one["interface"], one["data"], one["service"], text))
                self.assertEqual(row["node"], str(one.get("node", "")))
                self.assertEqual(row["problem"], "true" if one.get("problem") else "false")
                if value is None:
                    self.assertEqual(row["object"] + row["value"], "")
                    continue
                self.assertEqual(row["object"], value["index"])
                self.assertEqual((row["name"], row["unit"]), (value.get("name", ""), value.get("unit", "")))
                if isinstance(value["value"], bool | str):
                    self.assertIn(row["value"], (str(value["value"]).lower(), str(value["value"])))
                elif value["value"] is not None:
                    self.assertEqual(float(row["value"]), float(value["value"]))
        self.assertIsNone(next(records, None))

    def test_csv_has_no_formulas(self) -> None:
        """A spreadsheet evaluates a text that begins with = + - @; a name of a file or a text of a device is none."""
        sheet = self.folder / "names.eds"
        names = ("=1+1", "+1+1", "-1+1", "@SUM(A1)", "plain", "-5", "=1,2")
        sections = "".join(f"\n[{0x2000 + i:X}]\nParameterName={name}\nObjectType=7\nDataType=3\nAccessType=rw\nPDOMapping=0\n"
                           for i, name in enumerate(names))
        sections += "\n[2100]\nParameterName=text\nObjectType=7\nDataType=9\nAccessType=rw\nPDOMapping=0\n"
        sheet.write_text(f"[ManufacturerObjects]\nSupportedObjects={len(names) + 1}\n"
                         + "".join(f"{i + 1}=0x{0x2000 + i:X}\n" for i in range(len(names)))
                         + f"{len(names) + 1}=0x2100\n{sections}", encoding="utf-8")
        log = self.folder / "names.log"
        log.write_text("".join(f"({i}.0) can0 609#2B{i:02X}2000FBFF0000\n" for i in range(len(names)))
                       + "(8.0) can0 609#230021003D312B31\n", encoding="utf-8")
        text = edsc("--node", f"9={sheet}", log, "--format", "csv").stdout.decode()
        rows = list(csv.DictReader(io.StringIO(text, newline=""), strict=True))
        self.assertEqual([row["name"] for row in rows],
                         ["'=1+1", "'+1+1", "'-1+1", "'@SUM(A1)", "plain", "-5", "'=1,2", "text"])
        self.assertEqual([row["value"] for row in rows[:-1]], ["-5"] * len(names))
        self.assertEqual(rows[-1]["value"], '"=1+1"')
        for row in rows:
            for field in row.values():
                self.assertFalse(field.startswith(("=", "+", "@", "\t")), field)

    def test_csv_of_an_empty_log(self) -> None:
        self.assertEqual(len(edsc("--format", "csv").stdout.splitlines()), 1)
        refused = edsc("--format", "csv", "--summary")
        self.assertEqual(refused.returncode, WRONG_USAGE)
        self.assertIn(b"--summary", refused.stderr)


if __name__ == "__main__":
    if shutil.which("log2asc") is None:
        sys.exit("log2asc of can-utils is missing")
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
