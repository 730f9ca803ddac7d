#!/usr/bin/env python3
"""Devices in simulated time: the protocol of runtime/include/canopen_sim/simulated_device.hpp, and the commands of edsc with
addresses that begin with `simulated:`.

    simulated_test.py SOURCE_DIR EDSC SIMULATED_DEVICES [unittest arguments]

A frame of n bytes takes 47 + 8 n us at 1 Mbit/s (ISO 11898-1, without stuff bits), 20 us more with a CAN-ID of 29 bits.
"""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
DEVICES = Path(sys.argv[3]).resolve()
SHEET = SOURCE_DIR / "tests/fixtures/live_device.eds"
SCALED_SHEET = SOURCE_DIR / "tests/fixtures/scaled_drive.eds"
FINE, FAILED, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130
INCREMENTS_DIFFER = ("edsc: 608Fh:01 Position encoder resolution, Encoder increments = 4000 (00000FA0h) "
                     "(EDS: 2000 (000007D0h)); units are as in the device\n")


class Protocol(unittest.TestCase):
    maxDiff = None

    def play(self, *lines: str, exit_code: int = 0) -> list[str]:
        """Returns the answers to these lines, without the greeting."""
        result = subprocess.run([DEVICES], input="".join(f"{line}\n" for line in lines), capture_output=True, text=True,
                                timeout=600)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        self.stderr = result.stderr
        greeting, *answers = result.stdout.splitlines()
        self.assertEqual(greeting, "edsc-simulation 1")
        self.compositions = [answer for answer in answers if "composition=" in answer]
        return ["ok" if answer == "ok composition=edsc" else answer for answer in answers]

    def test_the_first_device_boots_up(self) -> None:
        self.assertEqual(self.play("node 5", "run 1000", "run 1000"), ["ok", "55 705 00", "1055"])

    def test_a_program_has_several_devices(self) -> None:
        self.assertEqual(self.play("node 5 every_service", "run 1000", "node 6 motor", "run 1000", "node 5 drill"),
                         ["ok", "55 705 00", "ok", "55 706 00", "no"])
        self.assertEqual(self.compositions, ["ok composition=edsc"], "the motor has an application")

    def test_an_answer_comes_when_its_frame_has_passed(self) -> None:
        self.assertEqual(self.play("node 5", "run 1000", "send 605 4000100000000000", "run 1000"),
                         ["ok", "55 705 00", "277 585 4300100092010200"])  # 55 + 111 + 111

    def test_one_frame_for_one_run(self) -> None:
        self.assertEqual(self.play("node 5", "send 605 4000100000000000", "run 1000", "run 1000", "run 0"),
                         ["ok", "166 705 00", "277 585 4300100092010200", "277"])

    def test_heartbeats_are_exact(self) -> None:
        self.assertEqual(self.play("node 5", "run 345", "run 290", "set 1017 00 E803", "run 100", *["run 2000000"] * 3),
                         ["ok", "55 705 00", "345", "ok", "400 705 7F", "1000400 705 7F", "2000400 705 7F",
                          "3000400 705 7F"])

    def test_what_the_application_does(self) -> None:
        answers = self.play("node 5", "run 100", "send 000 0105", "run 10000", "set 6041 0 3102", "run 1000",
                            "set 6041 00 31", "set 1000 00 00000000", "set 7000 00 00", "emergency 2310 02", "run 1000",
                            "emergency_over 02", "run 1000")
        self.assertEqual(answers[2:], [
            "213 185 500240E20100",  # on entering Operational: 55 + 63 + 95
            "ok", "308 185 310240E20100", "refused 06070013", "refused 06010002", "refused 06020000", "ok",
            "419 085 1023030000000000", "ok", "530 085 0000000000000000"])

    def test_an_application_of_the_user(self) -> None:
        answers = self.play("node 5 motor", "run 1000", "run 1000", "send 000 0105", "run 1000", "run 1000",
                            "send 205 00000A000000", "run 2000", "run 2000", "send 205 0000B80B0000", "run 2000",
                            "send 605 23FF6000B90B0000", "run 200", "run 1000", "run 1000")
        self.assertEqual(answers, [
            "ok", "55 705 00", "1055",  # start() has set 1017h to 500 ms before the boot-up message
            "1213 185 500240E20100", "2213",
            "3095 185 50024AE20100", "4095 185 500254E20100",  # every() moves the axis by 10 in each millisecond
            "5095 185 50020CEE0100",                             # and by 3000
            "5295", "5317 585 80FF600031000906",                 # 3001 is above 2005h
            "6095 185 5002C4F90100"])
        self.assertEqual(self.stderr, "velocity 10\nvelocity 3000\n")

    def test_frames_of_all_kinds(self) -> None:
        answers = self.play("node 5 every_service", "run 100", "send 705R 1", "run 1000",  # node guarding
                            "send 00000605X 4000100000000000", "send 605X 4000100000000000", "run 1000",
                            "send 605 23001203858500A0", "send 080", "run 1000")
        self.assertEqual(answers[:4], ["ok", "55 705 00", "157 705 7F", "1157"])

    def test_power_is_lost_and_what_is_stored_stays(self) -> None:
        save = "send 605 2310100173617665"
        write = "send 605 2B042000{}"
        read = "send 605 4004200000000000"
        answers = self.play("node 5", "run 100", write.format("D2040000"), save, "run 1000", "run 1000",
                            write.format("D3040000"), "run 1000", read, "run 1000", "power_cycle", "run 1000", read,
                            "run 1000")
        self.assertEqual([answer.partition(" ")[2] for answer in answers], [
            "", "705 00", "585 6004200000000000", "585 6010100100000000", "585 6004200000000000",
            "585 4B042000D3040000", "", "705 00", "585 4B042000D2040000"])

    def test_frames_that_wait_are_lost_with_the_power(self) -> None:
        answers = self.play("node 5", "emergency 2310 02", "power_cycle", "run 1000", "run 1000")
        self.assertEqual(answers, ["ok", "ok", "ok", "55 705 00", "1055"])

    def test_lss_gives_a_node_id_that_stays(self) -> None:
        configure = ("send 7E5 0401000000000000", "send 7E5 1109000000000000", "run 1000", "send 7E5 1700000000000000",
                     "run 1000")
        answers = self.play("node 255", "run 1000", *configure, "send 7E5 0400000000000000", "run 1000", "power_cycle",
                            "run 1000", "send 000 8109", "run 1000")
        self.assertEqual([answer.partition(" ")[2] for answer in answers],
                         ["", "", "7E4 1100000000000000", "7E4 1700000000000000", "709 00", "", "709 00", "709 00"])

    def test_a_line_that_is_malformed_ends_it(self) -> None:
        for line in ("", "node", "node 0", "node 128", "node x", "node 5 live more", "run", "run -1", "run 1 2",
                     "run 4294967295", "send", "send 800", "send 20000000X", "send 605 4", "send 605 4g",
                     "send 605 001122334455667788", "send 605R", "send 605R 9", "send 605 00 11", "send 60 5Z", "set 1000",
                     "set 1000 00 0", "set 10000 00 00", "emergency 1000", "emergency_over", "power_cycle 1", "stop"):
            with self.subTest(line):
                self.play("node 5", line, exit_code=2)
                self.assertIn(f"not understood: {line}\n", self.stderr)
        self.play("run 1000", exit_code=2)

    def test_its_help_names_the_devices(self) -> None:
        result = subprocess.run([DEVICES, "--help"], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, 2)
        self.assertIn("simulated:", result.stderr)
        self.assertIn("\n  motor\n", result.stderr)


class Commands(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-simulated-"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "devices").symlink_to(DEVICES)

    def edsc(self, command: str, address: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, command, address, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, timeout=600)

    def expect(self, result: subprocess.CompletedProcess[str], exit_code: int, stdout: str = "", stderr: str = "") -> None:
        self.assertEqual((result.stdout, result.stderr, result.returncode), (stdout, stderr, exit_code))

    def script(self, text: str) -> str:
        path = self.folder / "program"
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)
        return "simulated:program@5"

    def test_read(self) -> None:
        self.expect(self.edsc("read", "simulated:devices@5", 5, "1000h", "speed", "--eds", SHEET), FINE,
                    "1000h:00 Device type = 00020192h device_profile_number=drives_and_motion_control, servo_drive\n2004h:00 Speed = 1000 rpm\n")

    def test_write_with_an_application(self) -> None:
        self.expect(self.edsc("write", "simulated:devices@5,motor", 5, "60FFh", 3001, "--eds", SHEET), FAILED, "",
                    "edsc: 60FFh:00 Target velocity: refused by the device: 0609 0031h, value too high\n")

    def scaled_sheet(self, *changes: tuple[str, str]) -> str:
        """The EDS of the device `scaled_drive` with other texts."""
        text = SCALED_SHEET.read_text()
        for before, after in changes:
            self.assertEqual(text.count(before), 1)
            text = text.replace(before, after)
        (self.folder / "scaled.eds").write_text(text)
        return "scaled.eds"

    def test_scales_are_those_of_the_device(self) -> None:
        """The device has 4000 increments per revolution and rpm."""
        bus, entries = "simulated:devices@5,scaled_drive", ("6064h", "606Ch", "6083h")
        values = ("6064h:00 Position actual value = 1.5 rev\n606Ch:00 Velocity actual value = 1500 rpm\n"
                  "6083h:00 Profile acceleration = 250 rev/s²\n")
        self.expect(self.edsc("read", bus, 5, *entries, "--eds", SCALED_SHEET), FINE, values)
        other = self.scaled_sheet(("DefaultValue=4000", "DefaultValue=2000"), ("0x00B44700", "0xFFB44700"))
        differences = (INCREMENTS_DIFFER + "edsc: 60A9h:00 SI unit velocity = 11814656 (00B44700h) (EDS: 4290004736 (FFB44700h)); units are as in the device\n")
        self.expect(self.edsc("read", bus, 5, *entries, "--eds", other), FINE, values, differences)
        json_result = json.loads(self.edsc("read", bus, 5, "6064h", "--eds", other, "--format", "json").stdout)
        entry = json_result["entries"][0]
        self.assertEqual((entry["value"], entry["physical"], entry["unit"], entry["text"]), (6000, 1.5, "rev", "1.5 rev"))

    def test_a_value_is_written_in_the_scale_of_the_device(self) -> None:
        bus, other = "simulated:devices@5,scaled_drive", self.scaled_sheet(("DefaultValue=4000", "DefaultValue=2000"))
        difference = INCREMENTS_DIFFER
        sending = self.script("tee sent | ./devices") + ",scaled_drive"
        self.expect(self.edsc("write", sending, 5, "607Ah", "90 deg", "--eds", other, "--verify"), FINE,
                    "607Ah:00 Target position = 0.25 rev, verified\n", difference)
        self.assertIn("send 605 237A6000E8030000", (self.folder / "sent").read_text(), "1000 increments")
        self.expect(self.edsc("write", bus, 5, "607Ah", "90.01 deg", "--eds", other), WRONG_USAGE, "", difference
                    + 'edsc: 90.01 deg is between 0.25 rev and 0.25025 rev: 607Ah:00 "Target position"\n')

    def test_a_scale_that_the_device_does_not_have(self) -> None:
        """The EDS has 60A8h, which the device refuses: its positions are raw numbers, not those of the EDS."""
        bus = "simulated:devices@5,scaled_drive"
        sheet = self.scaled_sheet(("SupportedObjects=7", "SupportedObjects=8\n8=0x60A8"))
        with (self.folder / sheet).open("a") as file:
            file.write("\n[60A8]\nParameterName=SI unit position\nObjectType=7\nDataType=7\nAccessType=rw\nDefaultValue=0xFD010000\n")
        refused = ("edsc: 60A8h:00 SI unit position: refused by the device: 0602 0000h, object does not exist; "
                   "values in its unit are raw numbers\n")
        self.expect(self.edsc("read", bus, 5, "6064h", "--eds", sheet), FINE, "6064h:00 Position actual value = 6000\n", refused)
        result = self.edsc("write", bus, 5, "607Ah", "2 m", "--eds", sheet)
        self.assertEqual((result.stdout, result.returncode), ("", FAILED))
        self.assertTrue(result.stderr.startswith(refused), result.stderr)

    def test_commands_that_listen_name_the_scale(self) -> None:
        note = "edsc: node 5: units by the default values of {} in the EDS\n"
        notes = "".join(note.format(objects) for objects in ("608Fh", "60A9h", "60AAh"))
        (self.folder / "bus.log").write_text("(1.0) can0 605#4064600000000000\n(1.1) can0 585#4364600070170000\n")
        shown = subprocess.run([EDSC, "decode", "--node", f"5={SCALED_SHEET}", "bus.log"], cwd=self.folder,
                               capture_output=True, text=True, timeout=600)
        self.assertIn("6064h:00 Position actual value = 1.5 rev", shown.stdout)
        self.assertEqual(shown.stderr, notes)
        shown = self.edsc("monitor", "simulated:devices@5,scaled_drive", "--once", "0.1s", "--node", f"5={SCALED_SHEET}")
        self.assertEqual((shown.returncode, shown.stderr), (FINE, notes))

    def test_nmt(self) -> None:
        self.expect(self.edsc("nmt", "simulated:devices@5,motor", "start", 5, "--wait", "1000ms"), FINE)
        result = self.edsc("nmt", "simulated:devices@5", "start", 5, "--wait", "1000ms")
        self.assertEqual(result.returncode, FAILED)

    def test_scan(self) -> None:
        result = self.edsc("scan", "simulated:devices@77,every_service")
        self.assertEqual(result.returncode, FINE)
        self.assertEqual([line.split()[0] for line in result.stdout.splitlines()], ["node", "77"])

    def test_lss(self) -> None:
        result = self.edsc("lss", "simulated:devices@255", "fastscan")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))
        self.assertIn("00ABCDEFh", result.stdout)

    def test_an_hour_takes_a_moment(self) -> None:
        self.expect(self.edsc("nmt", "simulated:devices@5", "stop", 5, "--wait", "600000ms"), FAILED, "",
                    "edsc: node 5 did not report stopped within 10m: the last state that it reported is boot-up\n")

    def test_addresses(self) -> None:
        for address in ("simulated:", "simulated:devices", "simulated:devices@", "simulated:@5", "simulated:devices@0",
                        "simulated:devices@128", "simulated:devices@5,", "simulated:devices@5,a b"):
            with self.subTest(address):
                self.expect(self.edsc("nmt", address, "start", 5), WRONG_USAGE, "", f'edsc: "{address}" is not a simulation; '
                            "expected simulated:PROGRAM@NODE-ID[,NAME]\n")

    def test_programs_that_are_not_simulations(self) -> None:
        for text, problem in (("echo hello", 'unexpected line "hello" of the program; is it a simulation of edsc?'),
                              ("exit 3", "the program has ended with exit code 3"),
                              ("kill -9 $$", "the program was ended by signal 9 (Killed)"),
                              ("head -c 100000 /dev/zero", None)):
            with self.subTest(text):
                result = self.edsc("nmt", address := self.script(text), "start", 5)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertTrue(result.stderr.startswith(f"edsc: {address}: "), result.stderr)
                if problem:
                    self.assertEqual(result.stderr, f"edsc: {address}: {problem}\n")
        self.expect(self.edsc("nmt", "simulated:missing@5", "start", 5), WRONG_USAGE, "",
                    "edsc: missing: No such file or directory\n")
        (self.folder / "text").write_text("text")
        self.expect(self.edsc("nmt", "simulated:text@5", "start", 5), WRONG_USAGE, "", "edsc: text: Permission denied\n")
        self.expect(self.edsc("nmt", "simulated:devices@5,drill", "start", 5), WRONG_USAGE, "",
                    'edsc: simulated:devices@5,drill: the program does not have a device "drill"\n')

    def test_a_program_that_fails_while_it_is_used(self) -> None:
        hello = "echo edsc-simulation 1; read node; echo ok; read line; "
        for text, problem in ((hello + "exit 4", "the program has ended with exit code 4"),
                              (hello + "kill -11 $$", "the program was ended by signal 11 (Segmentation fault)"),
                              (hello + "echo 5 605 1", 'unexpected line "5 605 1" of the program; is it a simulation of edsc?'),
                              (hello + "echo now", 'unexpected line "now" of the program; is it a simulation of edsc?')):
            with self.subTest(text):
                self.expect(self.edsc("read", address := self.script(text), 5, "1000h", "--type", "u32"), FAILED, "",
                            f"edsc: {address}: the bus is lost: {problem}\n")

    def test_ctrl_c(self) -> None:
        for text in ("echo $$ > started; exec sleep 1000",
                     "echo edsc-simulation 1; read node; echo ok; echo $$ > started; exec sleep 1000"):
            with self.subTest(text):
                started = self.folder / "started"
                started.unlink(missing_ok=True)
                command = subprocess.Popen([EDSC, "nmt", self.script(text), "start", "5"], cwd=self.folder, text=True,
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE)
                self.addCleanup(command.kill)
                while not (started.exists() and started.read_text().endswith("\n")):
                    self.assertIsNone(command.poll())
                    time.sleep(0.01)
                command.send_signal(signal.SIGINT)
                stdout, stderr = command.communicate(timeout=600)
                self.assertEqual((stdout, stderr, command.returncode), ("", "edsc: interrupted\n", INTERRUPTED))
                self.assertFalse(Path(f"/proc/{started.read_text().strip()}").exists())


if __name__ == "__main__":
    del sys.argv[1:4]
    unittest.main()
