#!/usr/bin/env python3
"""Control characters and marks of bidirectional text in files and devices: no command passes them to a terminal or into
generated headers.

    hidden_text_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import unicodedata
import unittest
import urllib.request
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from network import Network  # noqa: E402

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()

# CSI as one character, and all marks of the Unicode Bidirectional Algorithm. edsc does not read a file with ESC.
HOSTILE = "\x9b31m\x7f\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\u2028"
BIDIRECTIONAL = {"LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI"}


def hidden(text: str) -> list[str]:
    """Returns characters that a terminal executes or an editor hides, except line ends."""
    return [f"U+{ord(c):04X}" for c in text
            if c != "\n" and (unicodedata.category(c) in ("Cc", "Zl", "Zp") or c in "\u061c\u200e\u200f" or
                              unicodedata.bidirectional(c) in BIDIRECTIONAL)]


def entry(section: str, name: str, data_type: int, access: str, value: str, more: str = "") -> str:
    return (f"\n[{section}]\nParameterName={name}{HOSTILE}\nObjectType=7\nDataType={data_type}\nAccessType={access}\n"
            f"DefaultValue={value}\n{more}")


def sheet(gain: str) -> str:
    """An EDS whose names, texts, comments and units are hostile."""
    return (f"[FileInfo]\nFileName=x{HOSTILE}.eds\nFileVersion=1\nFileRevision=1\nDescription=x{HOSTILE}\n"
            f"CreatedBy={HOSTILE}\n"
            f"[DeviceInfo]\nVendorName=v{HOSTILE}\nVendorNumber=1\nProductName=p{HOSTILE}\nProductNumber=2\n"
            f"OrderCode=o{HOSTILE}\nBaudRate_125=1\nNrOfRXPDO=0\nNrOfTXPDO=1\n"
            f"[Comments]\nLines=1\nLine1={HOSTILE}\n"
            "[DeviceComissioning]\nNodeID=5\nNodeName=n" + HOSTILE + "\nBaudrate=125\nNetNumber=1\n"
            "[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n"
            "[OptionalObjects]\nSupportedObjects=3\n1=0x1008\n2=0x1800\n3=0x1A00\n"
            "[ManufacturerObjects]\nSupportedObjects=2\n1=0x2000\n2=0x2001\n" +
            entry("1000", "Device type", 7, "ro", "0") + entry("1001", "Error register", 5, "ro", "0") +
            entry("1008", "Device name", 9, "const", f"name{HOSTILE}") +
            f"\n[1018]\nParameterName=Identity{HOSTILE}\nObjectType=9\nSubNumber=2\n" +
            entry("1018sub0", "Number", 5, "const", "1") + entry("1018sub1", "Vendor", 7, "ro", "1") +
            f"\n[1800]\nParameterName=TPDO{HOSTILE}\nObjectType=9\nSubNumber=3\n" +
            entry("1800sub0", "Number", 5, "const", "2") + entry("1800sub1", "COB-ID", 7, "rw", "$NODEID+0x180") +
            entry("1800sub2", "Type", 5, "rw", "255") +
            f"\n[1A00]\nParameterName=Mapping{HOSTILE}\nObjectType=9\nSubNumber=2\n" +
            entry("1A00sub0", "Number", 5, "const", "1") + entry("1A00sub1", "Entry", 7, "const", "0x20000010") +
            entry("2000", "Gain", 6, "rw", gain, f"PDOMapping=1\nLowLimit=0\nHighLimit=900\nUnit=u{HOSTILE}\n") +
            entry("2001", "Text", 9, "rw", f"text{HOSTILE}"))


class HiddenTextTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-hidden-"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "device.eds").write_text(sheet("5"))
        (self.folder / "newer.eds").write_text(sheet("6").replace("ParameterName=Text", "ParameterName=Other text"))
        (self.folder / "wrong.eds").write_text(sheet(f"x{HOSTILE}") + f"\n[nothing{HOSTILE}]\nwrong {HOSTILE}\n")

    def edsc(self, *arguments: object) -> str:
        result = subprocess.run([EDSC, *map(str, arguments)], cwd=self.folder, capture_output=True, timeout=600)
        self.assertGreaterEqual(result.returncode, 0)
        for output in (result.stdout, result.stderr):
            with self.subTest(command=" ".join(map(str, arguments))):
                self.assertEqual(hidden(output.decode()), [])
        return result.stdout.decode() + result.stderr.decode()


class OfFiles(HiddenTextTest):
    def test_check_and_diff(self) -> None:
        for file in ("device.eds", "wrong.eds"):
            self.assertIn("<U+202E>", self.edsc("check", file))
            for form in ("json", "sarif"):
                self.assertIn("\u202e", json.dumps(json.loads(self.edsc("check", file, "--format", form)), ensure_ascii=False))
        self.assertIn("Other text<U+009B>", self.edsc("diff", "device.eds", "newer.eds"))
        changes = json.loads(self.edsc("diff", "device.eds", "newer.eds", "--format", "json"))
        self.assertIn(f"Other text{HOSTILE}", [change["name"] for change in changes["changes"]])
        self.assertIn("&lt;U+202E\\>", self.edsc("diff", "device.eds", "newer.eds", "--format", "markdown"))

    def test_a_file_with_an_escape_sequence(self) -> None:
        (self.folder / "escape.eds").write_text(sheet("5").replace("ParameterName=Text", "ParameterName=\x1b[2JText"))
        for command in (("check",), ("dump",), ("format",), ("generate", "-o", "out")):
            self.assertIn("<U+001B>[2J", self.edsc(*command, "escape.eds"))

    def test_names_of_files(self) -> None:
        name = f"a{HOSTILE}\x1b[2J.eds"
        shutil.copy(self.folder / "wrong.eds", self.folder / name)
        for command in (("check", name), ("format", name, "--check"), ("diff", name, name), ("dump", name),
                        ("generate", name, "-o", "out"), ("check", f"missing{name}"), ("decode", f"missing{name}"),
                        ("generate", "device.eds", "-o", f"out{HOSTILE}", "--verbose")):
            self.edsc(*command)

    def test_arguments(self) -> None:
        for command in ((HOSTILE,), ("check", f"--{HOSTILE}"), ("check", "device.eds", "--format", HOSTILE),
                        ("check", "--explain", HOSTILE), ("check", "device.eds", "--silence", HOSTILE),
                        ("dump", "device.eds", "--node-id", HOSTILE), ("diff", "device.eds", "--against", HOSTILE),
                        ("scan", HOSTILE), ("bus", "--listen", HOSTILE), ("decode", "-", "--node", HOSTILE)):
            self.assertIn("<U+202E>", self.edsc(*command))

    def test_dump_is_the_same_device(self) -> None:
        device = json.loads(self.edsc("dump", "device.eds", "--cpp"))
        self.assertEqual(device["product_name"], f"p{HOSTILE}")

    def test_generated_headers(self) -> None:
        (self.folder / "device.options.json").write_text('{"stored_eds": true}')
        self.edsc("generate", "device.eds", "-o", "out", "--keep-going")
        headers = sorted((self.folder / "out/device").iterdir())
        self.assertGreaterEqual(len(headers), 4)
        for header in headers:
            self.assertEqual(hidden(header.read_text()), [], header.name)
        self.assertIn("Gain<U+009B>31m<U+007F>", (self.folder / "out/device/dictionary.hpp").read_text())

    def test_decode(self) -> None:
        log = ("(1.0) can0 705#00\n(1.1) can0 605#4008100000000000\n(1.2) can0 585#4108100014000000\n"
               "(1.3) can0 605#6000000000000000\n(1.4) can0 585#00C29BE280AE4142\n"
               "(1.5) can0 605#7000000000000000\n(1.6) can0 585#10611B5B324AC285\n(1.7) can0 605#6000000000000000\n"
               "(1.8) can0 585#039B414243444546\n(1.9) can0 185#0500\n(2.0) can0 605#2B00200005000000\n"
               f"(2.1) c\u202e0 705#05\nno frame {HOSTILE}\n")
        (self.folder / "log").write_text(log)
        text = self.edsc("decode", "log", "--node", "5=device.eds", "--summary")
        self.assertIn("Gain<U+009B>31m", text)
        self.assertIn(r"\xC2\x9B\xE2\x80\xAEABa\x1B[2J", text)
        for line in self.edsc("decode", "log", "--node", "5=device.eds", "--format", "json").splitlines():
            if line.startswith("{"):
                json.loads(line)


class OfDevices(HiddenTextTest):
    NAME = f"M\u202e\x9b31m\x1b[2J\u2066{chr(0x200f)}".encode() + b"\x9b\xff"

    def setUp(self) -> None:
        super().setUp()
        self.network = Network(EDSC, Path("unused"))
        self.addCleanup(self.network.close)
        self.network.device(self.answer)
        self.segments: list[bytes] = []

    def answer(self, frame: str) -> list[str]:
        """A node with hostile texts, which it sends in segments."""
        if frame.startswith(("605 40 08 10", "605 40 01 20")):
            self.segments = [self.NAME[i:i + 7] for i in range(0, len(self.NAME), 7)]
            self.toggle = 0
            return [f"585 41 {frame[7:15]} {len(self.NAME):02X} 00 00 00"]
        if frame.startswith(("605 60 ", "605 70 ")) and self.segments:
            segment = self.segments.pop(0)
            command = self.toggle << 4 | (7 - len(segment)) << 1 | (not self.segments)
            self.toggle ^= 1
            return [f"585 {command:02X} {segment.ljust(7, bytes(1)).hex(' ')}".upper()]
        if frame.startswith("605 40 00 20"):
            return ["585 4B 00 20 00 05 00 00 00", "705 05", "185 05 00"]
        if frame.startswith(("605 40 00 10", "605 40 18 10 01")):
            return [f"585 43 {frame[7:15]} 00 00 00 00"]
        return [f"585 80 {frame[7:15]} 00 00 02 06"] if frame.startswith("605 40") else []

    def test_read_write_and_scan(self) -> None:
        bus = self.network.address
        text = self.edsc("read", bus, 5, "1008h", "2000h", "2001h", "--eds", "device.eds")
        self.assertIn(r"M\xE2\x80\xAE\xC2\x9B31m\x1B[2J", text)
        self.edsc("read", bus, 5, "1008h", "2000h", "--type", "visible_string")
        self.edsc("read", bus, 5, "--all", "--eds", "device.eds")
        self.edsc("read", bus, 5, "nothing", "--eds", "device.eds")
        json.loads(self.edsc("read", bus, 5, "1008h", "2000h", "--eds", "device.eds", "--format", "json"))
        self.edsc("write", bus, 5, "2000h", "1000", "--eds", "device.eds")
        self.edsc("configure", bus, 5, "device.eds", "--dry-run")
        self.assertIn("M<U+202E><U+009B>31m<U+001B>[2J", self.edsc("scan", bus, "--nodes", "5", "--eds", "device.eds"))
        json.loads(self.edsc("scan", bus, "--nodes", "5", "--format", "json"))

    def test_monitor(self) -> None:
        bus = self.network.address
        for form in ("text", "json"):
            monitor = subprocess.Popen([EDSC, "monitor", bus, "--node", "5=device.eds", "--once", "15s", "--format", form],
                                       cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            while monitor.poll() is None:
                self.edsc("read", bus, 5, "2000h", "--eds", "device.eds")
            shown, said = monitor.communicate(timeout=600)
            self.assertEqual(hidden(shown.decode()) + hidden(said.decode()), [])
            self.assertIn("Gain", shown.decode())

    def test_the_page_of_the_monitor(self) -> None:
        monitor = subprocess.Popen([EDSC, "monitor", self.network.address, "--node", "5=device.eds", "--web", "127.0.0.1:0"],
                                   cwd=self.folder, stdout=subprocess.PIPE, text=True)
        self.addCleanup(monitor.communicate)
        self.addCleanup(monitor.kill)
        events = monitor.stdout.readline().strip().replace("/?", "/events?")
        self.network.client().send("185 01 02 03 04 05 06 07 08")
        rows = {}
        with urllib.request.urlopen(events, timeout=600) as stream:
            while "pdo" not in rows:
                data = stream.readline().decode().removeprefix("data: ")
                if data.startswith("{"):
                    rows.update((row["kind"], row) for row in json.loads(data)["rows"])
        texts = [rows["node"]["name"], rows["pdo"]["text"], *(value["name"] for value in rows["pdo"]["values"])]
        self.assertEqual(hidden("".join(texts)), [])
        self.assertIn("<U+202E>", rows["node"]["name"])
        self.assertIn("Gain", rows["pdo"]["text"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)
