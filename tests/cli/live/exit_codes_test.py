#!/usr/bin/env python3
"""The exit code has one meaning in all commands: 0 success, 1 the input or the device has errors, 2 wrong usage, a file or a bus that
cannot be used, 130 interrupted.

    exit_codes_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
import unittest

import standard_streams_test
from live import EDSC, FAILED, FINE, INTERRUPTED, WRONG_USAGE

LANGUAGE = json.loads(subprocess.run([EDSC, "completion", "json"], capture_output=True, text=True, check=True).stdout)
HAS_COMMANDS = {one["command"].rsplit(" ", 1)[0] for one in LANGUAGE["commands"] if " " in one["command"]} | {""}
COMMANDS = {one["command"]: one for one in LANGUAGE["commands"] if one["command"] not in HAS_COMMANDS}
NO_BUS = "socketcand:127.0.0.1:1/vcan0"  # no server listens there
# They have no input and no device that can be wrong.
CANNOT_FAIL = {"edit", "overlay from", "object export", "completion", "help", "version", "bus", "network members", "record", "monitor", "send sync", "send time", "send pdo",
               "send frame", "lss activate", "lss state"}

# More uses than those of standard_streams_test.py: the words with the exit code. @ is BUS.
MORE = {
    "network check": ("network check no_rate.json", FAILED),
    "network generate": ("network generate no_rate.json -o net", FAILED),
    "network simulate": ("network simulate plant.json --for 10ms", FINE),
    "network scan": ("network scan @ --eds . --nodes 100 --for 1ms --timeout 10ms -o none.json", FAILED),
    "network verify": ("network verify @ absent.json --timeout 10ms", FAILED),
    "network apply": ("network apply @ absent.json --timeout 10ms", FAILED),
    "network run": ("network run @ no_rate.json", FAILED),
    "scan": ("scan @ --nodes 100 --for 1ms --timeout 10ms", FAILED),
    "read": ("read @ 5 1018h:01 --type u32 --timeout 60s", FINE),
    "write": ("write @ 5 1017h 0 --type u16 --timeout 60s", FINE),
    "configure": ("configure @ 100 other.dcf --force --timeout 10ms", FAILED),
    "save": ("save @ 100 device.eds -o none.dcf --timeout 10ms", FAILED),
    "nmt": ("nmt @ reset-node 100 --wait 10ms", FAILED),
    "send pdo": ("send @ pdo 5 1 6040h=6 60FFh=0 --eds device.eds", FINE),
    "conform": ("conform @ 100 device.eds --only 2.1 --timeout 10ms", FAILED),
    "accept": ("accept @ 100 device.eds --only 2.1 --timeout 10ms", FAILED),
    "node": ("node @ broken.eds --node-id 9", FAILED),
    "watch": ("watch good.log --network plant.json --silence sdo-write --silence node-missing", FINE),
    "merge": ("merge device.eds third.eds other.eds", FAILED),
    "new": ("new other_new.eds --vendor-name Acme --cia 401 --tpdo-objects 2F77h", FAILED),
    "object add": ("object add device.eds 1017h", FAILED),
    "object set": ("object set device.eds 9999h ParameterName=a", FAILED),
    "object map": ("object map device.eds tpdo 1 9999h", FAILED),
    "object rename": ("object rename device.eds 9999h 9998h", FAILED),
    "object remove": ("object remove device.eds 9999h", FAILED),
    "object import": ("object import device.eds device.eds", FAILED),
    "overlay apply": ("overlay apply wrong.overlay -o none.eds", FAILED),
    "overlay rebase": ("overlay rebase wrong.overlay device.eds -o none.overlay", FAILED),
    "overlay from-bus": ("overlay from-bus @ 100 device.eds -o none.overlay --timeout 10ms", FAILED),
    "format": ("format broken.ini -o none.eds", FAILED),
    "decode": ("decode good.log", FINE),
    "audit": ("audit good.log --node 5=device.eds", FINE),
    "replay": ("replay same.log --node 5=device.eds", FINE),
    "discover": ("discover good.log", FINE),
    "lsp": ("lsp", FAILED),  # the end of its input without a request for the end
    "plot": ("plot good.log 1017h --node 5=device.eds -o plot.svg", FINE),
}
# A device in LSS configuration state is needed; lss_test.py has it.
WITH_LSS_DEVICE = {name for name in COMMANDS if name.startswith("lss ")}
# They wait for a node that does not answer, or for the end.
WAITING = {
    "read": "read @ 100 1018h:01 --timeout 60s",
    "write": "write @ 100 1017h 0 --type u16 --timeout 60s",
    "configure": "configure @ 100 other.dcf --force --timeout 60s",
    "save": "save @ 100 device.eds -o none.dcf --timeout 60s",
    "scan": "scan @ --nodes 100 --timeout 60s",
    "nmt": "nmt @ reset-node 100 --wait 60s",
    "conform": "conform @ 100 device.eds --only 2.1 --timeout 60s",
    "accept": "accept @ 100 device.eds --timeout 60s",
    "overlay from-bus": "overlay from-bus @ 100 device.eds -o none.overlay --timeout 60s",
    "network scan": "network scan @ --eds . --nodes 100 --timeout 60s -o none.json",
    "network verify": "network verify @ absent.json --timeout 60s",
    "network apply": "network apply @ absent.json --timeout 60s",
    "send sync": "send @ sync --every 10ms",
    "send time": "send @ time --every 10ms",
    "send frame": "send @ frame 123#01 --every 10ms",
    "send pdo": "send @ pdo 5 1 6040h=6 60FFh=0 --eds device.eds --every 10ms",
    "lss assign": "lss @ assign --node-id 7 --timeout 60s --step 10s",
    "lss fastscan": "lss @ fastscan --timeout 60s --step 10s",
    "lss select": "lss @ select --vendor 1 --product 1 --revision 1 --serial 1 --timeout 60s",
    "lss inquire": "lss @ inquire --timeout 60s",
    "lss node-id": "lss @ node-id 7 --timeout 60s",
    "lss bit-rate": "lss @ bit-rate 250 --timeout 60s",
    "lss store": "lss @ store --timeout 60s",
    "lss activate": "lss @ activate --delay 30s",
}
# Ctrl-C is their regular end.
ENDED_BY_USER = {"bus": "bus --listen 127.0.0.1:0", "monitor": "monitor @", "record": "record @ -o recorded.log",
                 "watch": "watch @ --network plant.json",
                 "node": "node @ device.eds --node-id 9", "network run": "network run @ absent.json"}
NOT_WAITING = {"lss state"}
# Without a bus, until the last page is closed or Ctrl-C.
WITH_PAGE = {"edit": "edit device.eds --no-browser"}


class ExitCodes(standard_streams_test.PreparedFiles):
    def setUp(self) -> None:
        super().setUp()
        self.write("good.log", "(1.0) vcan0 605#4017100000000000\n(1.001) vcan0 585#4B17100000000000\n")
        self.write("same.log", "(1.0) vcan0 605#4018100100000000\n(1.001) vcan0 585#43181001EFCDAB00\n")
        self.write("broken.ini", "[DeviceInfo\nVendorName\n")
        self.write("wrong.overlay", "[Overlay]\nVersion=1\nBase=device.eds\n\n[9999]\nDefaultValue=0 => 100\n")
        self.write("third.eds", (self.folder / "device.eds").read_text().replace("=0x00001001", "=0x00001003"))
        self.write("absent.json", json.dumps({"bit_rate": 500, "nodes": {"axis": {"node_id": 100, "eds": "device.eds"}}}))

    def words_of(self, text: str) -> list[str]:
        return [str(EDSC), *(word.replace("@", self.network.address) for word in text.split())]

    def exit_code(self, *words: str) -> tuple[int, str]:
        result = subprocess.run([EDSC, *words], cwd=self.folder, capture_output=True, text=True, timeout=100, stdin=subprocess.DEVNULL)
        return result.returncode, result.stderr + result.stdout

    def test_of_success_and_of_errors(self) -> None:
        known = {name: {row.exit_code for row in standard_streams_test.ROWS if row.words == name} for name in COMMANDS}
        for name, (words, expected) in MORE.items():
            with self.subTest(words=words):
                result = subprocess.run(self.words_of(words), cwd=self.folder, capture_output=True, text=True, timeout=600, stdin=subprocess.DEVNULL)
                self.assertEqual(result.returncode, expected, result.stderr)
                known[name].add(expected)
        for name in COMMANDS:
            if name not in WITH_LSS_DEVICE | set(ENDED_BY_USER) | set(WITH_PAGE):
                self.assertIn(FINE, known[name], name)
            if name not in CANNOT_FAIL | {"diff"}:
                self.assertIn(FAILED, known[name], name)

    def test_of_wrong_usage(self) -> None:
        for name, command in COMMANDS.items():
            words = [NO_BUS if word == "BUS" else word for word in command["usage"].split(" [OPTIONS]")[0].split()[1:]]
            with self.subTest(words=words):
                code, error = self.exit_code(*words, "--no-such-option")
                self.assertEqual(code, WRONG_USAGE)
                self.assertTrue(error.startswith('edsc: unknown option "--no-such-option"'), error)
                required = [one["names"][0] for one in command["arguments"] if one["required"]]
                if set(required) - {"BUS"}:
                    code, error = self.exit_code(*words)
                    self.assertEqual(code, WRONG_USAGE, name)
                    self.assertRegex(error, f"({'|'.join(required)}) is required")

    def test_of_a_missing_file(self) -> None:
        for name, command in COMMANDS.items():
            arguments = [one["names"][0] for one in command["arguments"]]
            if not {"FILE", "LOG", "BASE"} & set(arguments) or name in ("completion", "network generate", "new"):
                continue
            value = {"BUS": NO_BUS, "NODE": "5", "FILE": "no_such.eds", "LOG": "no_such.log", "BASE": "no_such.eds", "OBJECT": "1017h", "TARGET": NO_BUS,
                     "KEY=VALUE": "a=1", "DIRECTION": "tpdo", "NUMBER": "1", "NAME": "5F00h", "OTHER": "no_such.eds", "SOURCE": "no_such.csv"}
            given = [value[one] for one in arguments]
            if name == "diff":
                given = ["no_such.eds", "device.eds"]
            more = {"audit": ["--node", "5=device.eds"], "plot": ["--node", "5=device.eds"]}.get(name, [])
            output = ["-o", "none"] if name == "generate" else [] if not any("--output" in one["names"] and one["required"] for one in command["options"]) else ["-o", "none"]
            with self.subTest(command=name):
                code, error = self.exit_code(*name.split(), *given, *more, *output)
                self.assertEqual(code, WRONG_USAGE, error)
                self.assertIn("no_such", error)

    def test_of_a_missing_bus(self) -> None:
        checked = 0
        for name, text in (WAITING | {key: ENDED_BY_USER[key] for key in ENDED_BY_USER if key != "bus"}).items():
            if name == "configure":
                text = text.replace("--timeout", "--keep-state --timeout")
            with self.subTest(command=name):
                code, error = self.exit_code(*text.replace("@", NO_BUS).split())
                self.assertEqual(code, WRONG_USAGE, error)
                self.assertIn("127.0.0.1:1", error)
                checked += 1
        self.assertEqual(checked, len(WAITING) + len(ENDED_BY_USER) - 1)

    def test_of_an_interrupt(self) -> None:
        with_bus = {name for name, command in COMMANDS.items() if command["usage"].replace("[BUS]", "BUS").count("BUS")}
        self.assertEqual(with_bus, set(WAITING) | set(ENDED_BY_USER) - {"bus", "watch"} | NOT_WAITING)
        for name, text in (WAITING | ENDED_BY_USER | WITH_PAGE).items():
            with self.subTest(command=name):
                process = subprocess.Popen(self.words_of(text), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                time.sleep(0.5)
                self.assertIsNone(process.poll(), process.stderr.read() if process.poll() is not None else "")
                process.send_signal(signal.SIGINT)
                _, error = process.communicate(timeout=100)
                self.assertEqual(process.returncode, FINE if name in ENDED_BY_USER else INTERRUPTED, error)

if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
