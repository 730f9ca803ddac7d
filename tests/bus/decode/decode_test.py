#!/usr/bin/env python3
"""The output of edsc decode for small logs, and its behaviour in pipes.

    decode_test.py SOURCE_DIR EDSC [--update | unittest arguments]

A case in cases/ is a comment, the arguments, a log, and the output of edsc, in this order. `--update` writes the present
output: review the difference before you commit it.
"""

from __future__ import annotations

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
CASES = SOURCE_DIR / "tests/bus/decode/cases"
AXIS = "tests/bus/decode/axis.dcf"
SCHEMA = SOURCE_DIR / "docs/schema/message.schema.json"
PART = re.compile(r"^--- (log|output|errors|exit)(?: (\d+))?\n", re.MULTILINE)
FINE, INPUT_HAS_ERRORS, WRONG_USAGE = 0, 1, 2
SOON = 120.0


def edsc(*arguments: str, log: str = "", **more: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([EDSC, "decode", "--color", "never", *arguments], cwd=SOURCE_DIR, input=log, text=True,
                          errors="replace", capture_output=True, timeout=600, **more)


class Case:
    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = path.read_bytes().decode()  # line ends as they are
        parts = PART.split(self.text)
        self.head = parts[0]
        found = {name: (text, code) for name, code, text in zip(parts[1::3], parts[2::3], parts[3::3])}
        self.log = found["log"][0]
        self.arguments = re.search(r"^edsc decode (.*)$", self.head, re.MULTILINE)[1].split()

    def now(self) -> str:
        """The case with the present output of edsc."""
        result = edsc(*self.arguments, log=self.log)
        errors = f"--- errors\n{result.stderr}" if result.stderr else ""
        return f"{self.head}--- log\n{self.log}--- output\n{result.stdout}{errors}--- exit {result.returncode}\n"


class Cases(unittest.TestCase):
    maxDiff = None

    def test_are_what_edsc_says(self) -> None:
        paths = sorted(CASES.glob("*.case"))
        self.assertGreater(len(paths), 10)
        for path in paths:
            with self.subTest(case=path.name):
                case = Case(path)
                self.assertEqual(case.text, case.now())

    def test_show_every_service(self) -> None:
        outputs = "".join(PART.split(path.read_text(encoding="utf-8"))[6] for path in CASES.glob("*.case"))
        for label in ("NMT ", "SYNC ", "TIME ", "EMCY ", "BOOT-UP ", "HEART ", "GUARD ", "LSS >", "LSS <", "TPDO 1", "RPDO 1",
                      "SDO >", "SDO <", "ERROR ", "? "):
            self.assertIn(f" {label}", outputs)

    def test_are_the_same_in_json(self) -> None:
        """Each line of text has an object, which conforms to the schema and ends with the same words."""
        import jsonschema  # noqa: PLC0415

        validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text()))
        for path in sorted(CASES.glob("*.case")):
            case = Case(path)
            if "--format" in case.arguments:
                continue
            with self.subTest(case=path.name):
                text = edsc(*case.arguments, log=case.log).stdout.splitlines()
                objects = [json.loads(line) for line in edsc(*case.arguments, "--format", "json", log=case.log).stdout.splitlines()]
                for one in objects:
                    validator.validate(one)
                if "--summary" in case.arguments:
                    self.assertIn("summary", objects.pop())
                    text = text[:len(objects)]
                self.assertEqual(len(text), len(objects))
                for line, one in zip(text, objects):
                    self.assertTrue(line.endswith(one["text"].rstrip()), (line, one))


class Usage(unittest.TestCase):
    def refuse(self, *arguments: str, words: str) -> None:
        result = edsc(*arguments)
        self.assertEqual(result.returncode, WRONG_USAGE, result.stdout + result.stderr)
        self.assertIn(words, result.stderr)
        self.assertEqual(result.stdout, "")

    def test_a_log_that_is_not_there(self) -> None:
        self.refuse("missing.log", words="missing.log: No such file")

    def test_a_folder_as_log(self) -> None:
        self.refuse("tests", words="tests: Is a directory")

    def test_a_node_without_file(self) -> None:
        self.refuse("--node", "5=missing.eds", words="missing.eds")

    def test_a_node_id_that_there_is_not(self) -> None:
        self.refuse("--node", f"128={AXIS}", words="must be 1 to 127")
        self.refuse("--node", f"0={AXIS}", words="must be 1 to 127")

    def test_a_data_sheet_without_node_id(self) -> None:
        self.refuse("--node", "eds/rk5c.eds", words="does not state a node-ID")

    def test_a_node_that_is_given_twice(self) -> None:
        self.refuse("--node", AXIS, "--node", f"6={AXIS}", words="node 6 is given twice")

    def test_a_wrong_filter(self) -> None:
        self.refuse("--filter", "node=200", words="not a node-ID")
        self.refuse("--filter", "service=tcp", words="unknown service")
        self.refuse("--filter", "sdo", words="is not a condition")
        self.refuse("--filter", "colour=red", words="is not a condition")
        self.refuse("--filter", "id=xyz", words="not a CAN-ID")

    def test_a_node_id_before_the_dcfs_own(self) -> None:
        result = edsc("--node", f"9={AXIS}", log="can0 189#37020A000000\n")
        self.assertIn("TPDO 1   node 9 axis-y", result.stdout)


class Streams(unittest.TestCase):
    def start(self, *arguments: str, **more: object) -> subprocess.Popen[bytes]:
        process = subprocess.Popen([EDSC, "decode", "--node", AXIS, *arguments], cwd=SOURCE_DIR,
                                   stdin=subprocess.PIPE, bufsize=0, **{"stdout": subprocess.PIPE, **more})
        for pipe in (process.stdin, process.stdout, process.stderr):
            if pipe is not None:
                self.addCleanup(pipe.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def read_soon(self, descriptor: int) -> bytes:
        ready, _, _ = select.select([descriptor], [], [], SOON)
        self.assertTrue(ready, "no output")
        return os.read(descriptor, 65536)

    def test_a_line_is_shown_at_once(self) -> None:
        process = self.start("-")
        for number in range(3):
            process.stdin.write(b"can0 706#05\n")
            self.assertEqual(self.read_soon(process.stdout.fileno()).count(b"operational"), 1, number)
        process.stdin.write(b"can0 7")
        ready, _, _ = select.select([process.stdout], [], [], 0.2)
        self.assertFalse(ready, "an incomplete line is not a frame")
        process.stdin.write(b"06#04\n")
        self.assertIn(b"stopped", self.read_soon(process.stdout.fileno()))
        process.stdin.close()
        self.assertEqual(process.wait(SOON), FINE)

    def test_the_last_line_needs_no_line_end(self) -> None:
        self.assertIn("operational", edsc("--node", AXIS, log="can0 706#05").stdout)

    def test_a_closed_pipe_is_quiet(self) -> None:
        process = self.start("-", stderr=subprocess.PIPE)
        process.stdout.close()
        for _ in range(100):
            try:
                process.stdin.write(b"can0 706#05\n" * 100)
            except BrokenPipeError:
                break
            time.sleep(0.01)
        self.assertEqual(process.wait(SOON), FINE)
        self.assertEqual(process.stderr.read(), b"")

    def test_an_interrupt_ends_the_log_with_the_summary(self) -> None:
        process = self.start("-", "--summary")
        process.stdin.write(b"can0 706#05\n")
        self.assertIn(b"operational", self.read_soon(process.stdout.fileno()))
        process.send_signal(signal.SIGINT)
        self.assertIn(b"1 frame\n", self.read_soon(process.stdout.fileno()))
        self.assertEqual(process.wait(SOON), FINE)

    def test_a_full_disk_is_told(self) -> None:
        if not os.path.exists("/dev/full"):
            self.skipTest("SKIPPED: no /dev/full")
        with open("/dev/full", "wb") as full:
            process = self.start("-", stdout=full, stderr=subprocess.PIPE)
            _, errors = process.communicate(b"can0 706#05\n", timeout=SOON)
        self.assertEqual(process.returncode, WRONG_USAGE)
        self.assertIn(b"No space left", errors)

    def test_colour_only_on_a_terminal(self) -> None:
        master, slave = pty.openpty()
        environment = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
        process = self.start("-", stdout=slave, env=environment)
        os.close(slave)
        process.stdin.write(b"can0 086#1110010000000000\n")
        self.assertIn(b"\x1b[31m", self.read_soon(master))
        os.close(master)
        self.assertNotIn("\x1b", edsc("--node", AXIS, "--color", "auto", log="can0 086#1110010000000000\n").stdout)

    def test_long_lines_take_no_memory(self) -> None:
        result = edsc("--node", AXIS, log="x" * 10_000_000 + "\ncan0 706#05\n")
        self.assertEqual(result.returncode, INPUT_HAS_ERRORS)
        self.assertIn("<stdin>:1: skipped", result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1)
        self.assertIn("operational", result.stdout)

    def test_the_100th_broken_line_is_counted_only(self) -> None:
        result = edsc(log="nothing\n" * 100)
        self.assertEqual(result.stderr.count("skipped"), 50)
        self.assertIn("50 more lines like these", result.stderr)

    def test_a_file_is_read_as_standard_input_is(self) -> None:
        log = Case(CASES / "pdo.case").log
        with tempfile.NamedTemporaryFile("w", suffix=".log") as file:
            file.write(log)
            file.flush()
            self.assertEqual(edsc("--node", AXIS, file.name).stdout, edsc("--node", AXIS, "-", log=log).stdout)


def update() -> int:
    for path in sorted(CASES.glob("*.case")):
        case = Case(path)
        path.write_bytes(case.now().encode())
    return 0


if __name__ == "__main__":
    if "--update" in sys.argv:
        sys.exit(update())
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
