#!/usr/bin/env python3
"""The behaviour of edsc node beyond the protocol: commands on standard input, scripts and faults, as frames on the bus.

    node_behaviour_test.py SOURCE_DIR EDSC

The device is eds/cpc-tc1.eds. Its TPDO 1 has the statusword; TPDO 2 has the statusword and the position; both are sent after
each new value and at least each 100 ms.
"""

from __future__ import annotations

import configparser
import json
import re
import signal
import struct
import sys
import time
import unittest

from node_bus import FAILED, FINE, NMT, PATIENCE, RESET_NODE, SOURCE_DIR, START, WRONG_USAGE, NodeOnBus, device
from sdo import Abort, SdoClient, Silence

NODE = 5
BOOT_UP, EMCY, TPDO1, TPDO2, RESPONSE, REQUEST = 0x705, 0x085, 0x185, 0x285, 0x585, 0x605
LSS_MASTER, LSS_SLAVE = 0x7E5, 0x7E4
CONTROLWORD, STATUSWORD, POSITION, HEARTBEAT = 0x6040, 0x6041, 0x6064, 0x1017
SHORT = 1.0  # for frames that must not be received


def i32(value: int) -> bytes:
    return struct.pack("<i", value)


def u16(value: int) -> bytes:
    return struct.pack("<H", value)


class Behaviour(NodeOnBus):
    def begin(self, *words: object, script: object = None) -> None:
        """A node 5 that has booted."""
        if script is not None:
            (self.folder / "drive.behaviour.json").write_text(json.dumps(script))
            words = (*words, "--script", "drive.behaviour.json")
        self.process, _ = self.node(device("cpc-tc1"), "--node-id", NODE, *words)
        self.expect_frame(BOOT_UP, b"\0")
        self.sdo = SdoClient(self.wire, NODE, PATIENCE)

    def command(self, line: str) -> str:
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.process.stdout.readline().rstrip("\n")

    def obeys(self, *lines: str) -> None:
        for line in lines:
            self.assertEqual(self.command(line), "ok", line)

    def start(self) -> None:
        self.wire.send(NMT, bytes([START, NODE]))

    def positions(self, count: int) -> list[int]:
        """The next different positions of TPDO 2."""
        self.wire.forget()
        found: list[int] = []
        end = time.monotonic() + PATIENCE
        while len(found) < count and time.monotonic() < end:
            data = self.wire.receive(TPDO2, PATIENCE)
            self.assertIsNotNone(data)
            position = struct.unpack_from("<i", data, 2)[0]
            if not found or found[-1] != position:
                found.append(position)
        self.assertEqual(len(found), count, found)
        return found

    def expect_upload(self, index: int, data: bytes, sub_index: int = 0) -> None:
        end = time.monotonic() + PATIENCE
        while (found := self.sdo.upload(index, sub_index)) != data and time.monotonic() < end:
            time.sleep(0.02)
        self.assertEqual(found, data)

    def expect_emergency(self, code: int) -> None:
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            data = self.wire.receive(EMCY, PATIENCE)
            if data is not None and struct.unpack_from("<H", data)[0] == code:
                return
        self.fail(f"EMCY {code:04X}h is missing")

    def quiet(self, can_id: int) -> None:
        self.wire.forget()
        self.assertIsNone(self.wire.receive(can_id, SHORT))


class Commands(Behaviour):
    def test_values(self) -> None:
        self.begin()
        self.obeys("set statusword 0x250", "set 6064h -77")
        self.assertEqual(self.sdo.upload(STATUSWORD, 0), u16(0x250))
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(-77))
        self.assertRegex(self.command("get 6064h"), r"\Aok -77\b")
        self.assertRegex(self.command("get 6041h"), r"\Aok 0250h")
        self.assertEqual(self.command("5: get 6064h"), self.command("get 6064h"))
        self.assertRegex(self.command("set no_such_name 1"), r"\Aerror: .*no_such_name")
        self.assertRegex(self.command("ste 6064h 1"), r'\Aerror: "ste" is not a command; did you mean "set"\?')
        self.assertRegex(self.command("set 6064h"), r"\Aerror: VALUE\.\.\. is missing")
        self.assertRegex(self.command("ramp 6064h 0 10 soon"), r"\Aerror: .*soon")
        self.assertEqual(self.command("6: state"), "error: edsc node does not have a node 6")
        self.obeys("quit")
        self.assertEqual(self.process.wait(timeout=PATIENCE), FINE)

    def test_generators(self) -> None:
        self.begin("--start")
        self.obeys("ramp 6064h 100 1100 2s")
        rising = self.positions(8)
        self.assertEqual(rising, sorted(rising))
        self.expect_upload(POSITION, i32(1100))
        self.obeys("sine 6064h -1000 1000 1s")
        values = self.positions(100)
        self.assertLess(min(values), -500)
        self.assertGreater(max(values), 500)
        self.assertLessEqual(max(map(abs, values[1:])), 1000)
        self.obeys("count 6064h 5000 3 20ms")
        counted = [value for value in self.positions(9) if value >= 5000]
        self.assertTrue(all((value - 5000) % 3 == 0 for value in counted), counted)
        self.assertEqual(counted, sorted(counted))
        self.obeys("noise 6064h 20000 30000 20ms")
        noise = [value for value in self.positions(12) if value >= 20000]
        self.assertTrue(all(20000 <= value <= 30000 for value in noise), noise)
        self.assertNotEqual(noise, sorted(noise))
        self.obeys("constant 6064h 42")
        self.expect_upload(POSITION, i32(42))
        self.obeys("stop 6064h")
        self.assertRegex(self.command("stop 6064h"), r"\Aerror: 6064h:00 does not have a generator")

    def test_emergencies_states_and_power(self) -> None:
        self.begin()
        self.obeys("emcy 8130h 11")
        self.expect_emergency(0x8130)
        self.assertEqual(self.sdo.upload(0x1001, 0), b"\x11")
        self.obeys("emcy-over 11")
        self.expect_emergency(0x0000)
        self.obeys("nmt start")
        self.assertEqual(self.command("state"), "ok operational")
        self.assertIsNotNone(self.wire.receive(TPDO1, PATIENCE))
        self.wire.forget()
        self.obeys("power-cycle")
        self.expect_frame(BOOT_UP, b"\0")
        self.assertEqual(self.command("state"), "ok pre-operational")
        self.obeys("can off")
        self.assertEqual(self.command("state"), "ok pre-operational, not connected")
        self.sdo.timeout = SHORT
        self.assertRaises(Silence, self.sdo.upload, POSITION, 0)
        self.sdo.timeout = PATIENCE
        self.obeys("can active")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))

    def test_several_nodes(self) -> None:
        self.process, _ = self.node(device("cpc-tc1"), "--node-id", 5, "--count", 2, ready=2)
        for node_id in (5, 6):
            self.expect_frame(0x700 + node_id, b"\0")
        self.obeys("5: set 6064h 5", "6: set 6064h 6")
        self.assertEqual(self.command("set 6064h 7"), "error: the node-ID is missing, as in 5: state")
        for node_id in (5, 6):
            self.assertEqual(SdoClient(self.wire, node_id, PATIENCE).upload(POSITION, 0), i32(node_id))

    def test_outputs_are_wired_to_inputs(self) -> None:
        """The outputs of can-2057c, and inputs that are made of them."""
        eds = configparser.ConfigParser(interpolation=None, strict=False)
        eds.optionxform = str
        eds.read(device("can-2057c"), encoding="latin-1")
        for name in [name for name in eds.sections() if name.startswith("6200")]:
            eds[name.replace("6200", "6000")] = dict(eds[name])
        count = int(eds["OptionalObjects"]["SupportedObjects"], 0) + 1
        eds["OptionalObjects"].update({"SupportedObjects": str(count), str(count): "0x6000"})
        with (self.folder / "io.eds").open("w", encoding="latin-1") as file:
            eds.write(file, space_around_delimiters=False)
        self.process, _ = self.node("io.eds", "--node-id", NODE, "--keep-going", "--quiet", ready=0)
        self.expect_frame(BOOT_UP, b"\0")
        self.sdo = SdoClient(self.wire, NODE, PATIENCE)
        self.sdo.download(0x6200, 1, b"\x5a")
        self.assertEqual(self.sdo.upload(0x6000, 1), b"\0")
        self.obeys("loop on")
        for value in (b"\x5a", b"\xa5"):
            self.sdo.download(0x6200, 1, value)
            self.expect_upload(0x6000, value, 1)
        self.obeys("loop off")
        self.sdo.download(0x6200, 1, b"\x11")
        self.assertEqual(self.sdo.upload(0x6000, 1), b"\xa5")

    # ---- device profiles ----

    def walk_to_operation(self) -> None:
        """The transitions 2, 3 and 4 of CiA 402, with the states of Table 30 as bits of the statusword."""
        for command, state in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            self.sdo.download(CONTROLWORD, 0, u16(command))
            self.expect_masked(STATUSWORD, 0x6F, state)

    def expect_masked(self, index: int, mask: int, bits: int) -> None:
        end = time.monotonic() + PATIENCE
        while (found := int.from_bytes(self.sdo.upload(index, 0), "little") & mask) != bits and time.monotonic() < end:
            time.sleep(0.02)
        self.assertEqual(found, bits, f"{index:04X}h")

    def begin_drive(self, name: str = "cia402_drive") -> None:
        self.process, _ = self.node(SOURCE_DIR / f"tests/fixtures/{name}.eds", "--node-id", NODE, "--device-profile")
        self.expect_frame(BOOT_UP, b"\0")
        self.sdo = SdoClient(self.wire, NODE, PATIENCE)

    def test_a_drive_moves_by_its_profile(self) -> None:
        self.begin_drive()
        self.expect_masked(STATUSWORD, 0x4F, 0x40)  # Switch On Disabled, without a command
        self.sdo.download(0x6060, 0, b"\x01")
        for index, value in ((0x6081, 10_000), (0x6083, 100_000), (0x6084, 100_000), (0x607A, 5_000)):
            self.sdo.download(index, 0, i32(value))
        self.walk_to_operation()
        self.expect_upload(0x6061, b"\x01")
        began = time.monotonic()
        self.sdo.download(CONTROLWORD, 0, u16(0x1F))  # new set-point
        self.expect_masked(STATUSWORD, 0x1000, 0x1000)  # set-point acknowledge
        self.expect_upload(POSITION, i32(5_000))
        # 5000 increments at 10000 per second, with ramps of 0.1 s: 0.6 s, the first and last requests in addition.
        self.assertGreater(time.monotonic() - began, 0.55)
        self.expect_masked(STATUSWORD, 0x0400, 0x0400)  # target reached
        self.sdo.download(CONTROLWORD, 0, u16(0x02))
        self.expect_masked(STATUSWORD, 0x4F, 0x40)

    def test_a_drive_has_each_mode_of_the_standard(self) -> None:
        """CiA 402-2: what a target means, by its actual value. Modes are changed in Operation Enabled."""
        self.begin_drive("every_mode")
        for index in (0x6081, 0x6083, 0x6084):
            self.sdo.download(index, 0, i32(1_000_000))
        self.walk_to_operation()

        def mode(number: int) -> None:
            self.sdo.download(CONTROLWORD, 0, u16(0x0F))
            for index, size in ((0x6042, 2), (0x60FF, 4), (0x6071, 2)):
                self.sdo.download(index, 0, bytes(size))
            self.sdo.download(0x6060, 0, bytes([number]))
            self.expect_upload(0x6061, bytes([number]))

        mode(2)  # velocity, with the ramp enabled, unlocked and following 6042h
        self.sdo.download(0x6046, 2, i32(10_000))
        self.sdo.download(CONTROLWORD, 0, u16(0x7F))
        self.sdo.download(0x6042, 0, u16(300))
        self.expect_upload(0x6044, u16(300))
        mode(3)  # profile velocity
        self.sdo.download(0x60FF, 0, i32(-500))
        self.expect_upload(0x606C, i32(-500))
        mode(9)  # cyclic synchronous velocity
        self.sdo.download(0x60FF, 0, i32(700))
        self.expect_upload(0x606C, i32(700))
        for number in (4, 10):  # profile torque, cyclic synchronous torque
            mode(number)
            self.sdo.download(0x6071, 0, u16(50))
            self.expect_upload(0x6077, u16(50))
        mode(6)  # homing, method 37: the present position becomes 607Ch
        self.sdo.download(0x607C, 0, i32(4_321))
        self.sdo.download(0x6098, 0, b"\x25")
        self.sdo.download(CONTROLWORD, 0, u16(0x1F))
        self.expect_masked(STATUSWORD, 0x3000, 0x1000)  # homing attained, without an error
        mode(1)  # profile position
        self.sdo.download(0x607A, 0, i32(5_000))
        self.sdo.download(CONTROLWORD, 0, u16(0x1F))
        self.expect_upload(POSITION, i32(5_000))
        mode(8)  # cyclic synchronous position
        self.sdo.download(0x607A, 0, i32(5_200))
        self.expect_upload(POSITION, i32(5_200))
        mode(7)  # interpolated position, with a buffer that 60C4h:06 enables
        self.sdo.download(0x60C4, 6, b"\x01")
        self.sdo.download(CONTROLWORD, 0, u16(0x1F))
        self.expect_masked(STATUSWORD, 0x1000, 0x1000)
        self.sdo.download(0x60C1, 1, i32(5_300))
        self.expect_upload(POSITION, i32(5_300))

    def test_a_drive_that_loses_its_master(self) -> None:
        """NMT Stopped is a loss of communication: with 6007h = 1 a fault."""
        self.begin_drive()
        self.walk_to_operation()
        self.sdo.download(0x6007, 0, u16(1))
        self.wire.send(NMT, bytes([0x02, NODE]))
        self.wire.send(NMT, bytes([0x80, NODE]))
        self.expect_masked(STATUSWORD, 0x4F, 0x08)  # Fault
        self.sdo.download(CONTROLWORD, 0, u16(0x80))  # fault reset
        self.expect_masked(STATUSWORD, 0x4F, 0x40)

    def test_a_drive_without_6060_follows_the_target_written_last(self) -> None:
        self.begin("--device-profile")
        self.walk_to_operation()
        for target in (100, 400, -200):
            self.sdo.download(0x607A, 0, i32(target))
            self.expect_upload(POSITION, i32(target))
        self.sdo.download(0x60FF, 0, i32(-300))
        self.expect_upload(0x606C, i32(-300))

    def test_an_encoder_moves_and_takes_a_preset(self) -> None:
        process, _ = self.node(device("rk5c"), "--node-id", NODE, "--device-profile")
        self.expect_frame(BOOT_UP, b"\0")
        sdo = SdoClient(self.wire, NODE, PATIENCE)
        seen = set()
        end = time.monotonic() + PATIENCE
        while len(seen) < 5 and time.monotonic() < end:
            seen.add(sdo.upload(0x6020, 1))
            time.sleep(0.05)
        self.assertEqual(len(seen), 5)
        self.assertNotEqual(int.from_bytes(sdo.upload(0x6030, 1), "little"), 0)
        sdo.download(0x6010, 1, i32(1_000_000))
        position = struct.unpack("<i", sdo.upload(0x6020, 1))[0]
        self.assertLess(abs(position - 1_000_000), 4096)
        sdo.download(0x6200, 0, u16(40))
        self.assertEqual(sdo.upload(0x1800, 5)[:2], u16(40))
        process.kill()

    def test_a_profile_without_behaviour(self) -> None:
        text = device("cpc-tc1").read_text(encoding="latin-1").replace("0x00420192", "0x004201A2")
        (self.folder / "other.eds").write_text(text, encoding="latin-1")
        self.assertIn("0x004201A2", text)
        problem = self.refused(WRONG_USAGE, "other.eds", "--node-id", NODE, "--keep-going", "--device-profile")
        self.assertIn("1000h states CiA 418", problem)

    def test_the_end_of_standard_input_does_not_end_the_node(self) -> None:
        self.begin()
        self.process.stdin.write("set 6064h 9")
        self.process.stdin.close()
        self.process.stdin = None
        self.assertEqual(self.process.stdout.readline(), "ok\n")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(9))
        self.process.send_signal(signal.SIGTERM)
        self.assertEqual(self.process.wait(timeout=PATIENCE), FINE)

    def test_log(self) -> None:
        self.begin("--log", "node.log")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.obeys("quit")
        self.process.wait(timeout=PATIENCE)
        lines = (self.folder / "node.log").read_text().splitlines()
        frames = [re.fullmatch(r"\(\d+\.\d{6}\) vcan0 (\S+)", line)[1] for line in lines]
        self.assertEqual(frames[0], "705#00")
        self.assertIn("605#4064600000000000", frames)
        self.assertIn("585#4364600000000000", frames)


class Scripts(Behaviour):
    def test_values_survive_resets(self) -> None:
        self.begin(script={"set": {"6064h": 33, "statusword": "0x21"}})
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(33))
        self.obeys("set 6064h 34")
        self.wire.send(NMT, bytes([RESET_NODE, NODE]))
        self.expect_frame(BOOT_UP, b"\0")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(33))
        self.assertEqual(self.sdo.upload(STATUSWORD, 0), u16(0x21))

    def test_generators_and_copies(self) -> None:
        self.begin(script={"generate": {"6064h": "count 10 5 50ms"},
                           "copy": [{"from": "60FFh", "to": "606Ch", "after": "300ms"}]})
        self.start()
        self.assertTrue(all(value % 5 == 0 for value in self.positions(4)))
        self.sdo.download(0x60FF, 0, i32(1500))
        self.assertEqual(self.sdo.upload(0x60FF, 0), i32(1500))
        self.expect_upload(0x606C, i32(1500))

    def test_rules_of_values(self) -> None:
        self.begin(script={"rules": [
            {"name": "enable", "on": {"written": "6040h", "equals": 15}, "do": ["set 6041h 0x237"]},
            {"name": "disable", "on": {"written": "6040h", "mask": 0x100, "changed": True}, "do": ["set 6041h 0x250"]},
            {"name": "limit", "on": {"written": "607Ah", "above": 1000}, "refuse": "0609 0031h"},
            {"name": "hot", "on": {"changes": "6064h", "above": 100}, "do": ["emcy 4210h"]},
            {"name": "secret", "on": {"read": "606Ch"}, "refuse": "0800 0022h", "times": 2}]})
        self.sdo.download(CONTROLWORD, 0, u16(14))
        self.assertEqual(self.sdo.upload(STATUSWORD, 0), u16(0))
        self.sdo.download(CONTROLWORD, 0, u16(15))
        self.expect_upload(STATUSWORD, u16(0x237))
        self.sdo.download(CONTROLWORD, 0, u16(0x100))
        self.expect_upload(STATUSWORD, u16(0x250))
        self.start()
        self.wire.send(0x205, u16(15))  # RPDO 1
        self.expect_upload(STATUSWORD, u16(0x237))
        self.sdo.download(0x607A, 0, i32(1000))
        with self.assertRaises(Abort) as refused:
            self.sdo.download(0x607A, 0, i32(1001))
        self.assertEqual(refused.exception.code, 0x0609_0031)
        self.assertEqual(self.sdo.upload(0x607A, 0), i32(1000))
        self.obeys("ramp 6064h 0 200 300ms")
        self.expect_emergency(0x4210)
        for _ in range(2):
            with self.assertRaises(Abort) as refused:
                self.sdo.upload(0x606C, 0)
            self.assertEqual(refused.exception.code, 0x0800_0022)
        self.assertEqual(self.sdo.upload(0x606C, 0), i32(0))

    def test_rules_of_events(self) -> None:
        self.begin(script={"rules": [
            {"name": "on", "on": {"power-on": True}, "do": ["set 6064h 1"]},
            {"name": "late", "on": {"time": "500ms"}, "do": ["emcy 5530h"]},
            {"name": "beat", "on": {"every": "50ms"}, "times": 3, "do": ["emcy 5540h"]},
            {"name": "running", "on": {"state": "operational"}, "after": "100ms", "once": True, "do": ["set 6064h 2"]},
            {"name": "third", "on": {"sync": 3}, "do": ["set 606Ch 3"]},
            {"name": "by hand", "on": {"time": "1h"}, "do": ["set 607Ah 4"]}]})
        self.expect_emergency(0x5530)
        self.expect_upload(POSITION, i32(1))
        self.start()
        self.expect_upload(POSITION, i32(2))
        for _ in range(2):
            self.wire.send(0x080)
        self.assertEqual(self.sdo.upload(0x606C, 0), i32(0))
        self.wire.send(0x080)
        self.expect_upload(0x606C, i32(3))
        self.obeys('fire "by hand"')
        self.expect_upload(0x607A, i32(4))
        self.assertRegex(self.command("fire thrid"), r'\Aerror: "thrid" is not a rule; did you mean "third"\?')

    def test_a_rule_that_fires_itself_repeats(self) -> None:
        self.begin(script={"rules": [
            {"name": "blink", "on": {"power-on": True}, "after": "50ms", "do": ["emcy 5530h", "emcy-over", "fire blink"]},
            {"name": "busy", "on": {"power-on": True}, "do": ["fire busy"]}]})
        for _ in range(3):
            self.expect_emergency(0x5530)
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))

    def test_errors_have_a_line(self) -> None:
        wrong = {"set": {"no_such": 1}, "generate": {"6064h": "rmap 0 1 5s"}, "no_such_member": 1,
                 "rules": [{"on": {"writen": "6040h"}, "do": ["get 6040h", "fault silnt"]}]}
        (self.folder / "wrong.behaviour.json").write_text(json.dumps(wrong, indent=1))
        errors = self.refused(FAILED, device("cpc-tc1"), "--node-id", NODE, "--script", "wrong.behaviour.json")
        for text in ("no_such", "rmap", "unknown member no_such_member", "unknown member writen; did you mean \"written\"?",
                     "get is not a command of rules", "did you mean \"silent\"?"):
            self.assertRegex(errors, rf"(?m)^wrong\.behaviour\.json:\d+:\d+: error: .*{re.escape(text)}")

    def test_rules_that_contradict_themselves_or_each_other(self) -> None:
        every, action = {"every": "1s"}, ["set 6064h 1"]
        rows = (({"on": every}, "a rule requires do or refuse"),
                ({"do": action}, "a rule requires on, with an event"),
                ({"on": every, "do": ["set 9999h 1"]}, "9999h"),
                ({"on": every, "do": action, "once": True, "times": 5}, "once and times contradict each other"),
                ({"on": every, "refuse": "0609 0031h"}, "refuse requires on written or read"),
                ({"name": "first", "on": every, "do": action}, 'two rules have the name "first"'))
        for rule, message in rows:
            with self.subTest(message):
                rules = [{"name": "first", "on": every, "do": action}, rule]
                (self.folder / "wrong.behaviour.json").write_text(json.dumps({"rules": rules}))
                errors = self.refused(FAILED, device("cpc-tc1"), "--node-id", NODE, "--script", "wrong.behaviour.json")
                self.assertEqual(errors.count("error:"), 1, errors)
                self.assertIn(message, errors)

    def test_the_same_seed_gives_the_same_values(self) -> None:
        script = {"generate": {"6064h": "noise 0 1000000 1s"}}
        (self.folder / "noise.behaviour.json").write_text(json.dumps(script))
        found = []
        for seed in (1, 1, 2):
            self.process, _ = self.node(device("cpc-tc1"), "--node-id", NODE, "--seed", seed, "--script", "noise.behaviour.json")
            self.expect_frame(BOOT_UP, b"\0")
            found.append(SdoClient(self.wire, NODE, PATIENCE).upload(POSITION, 0))
            self.end(self.process)
        self.assertEqual(found[0], found[1])
        self.assertNotEqual(found[0], found[2])


class Faults(Behaviour):
    def fault(self, *lines: str) -> None:
        self.obeys(*(f"fault {line}" for line in lines))

    def no_answer(self, *address: int) -> None:
        self.sdo.timeout = SHORT
        self.assertRaises(Silence, self.sdo.upload, *address)
        self.sdo.timeout = PATIENCE
        self.wire.forget()

    def test_silent_for_a_time(self) -> None:
        self.begin()
        self.fault("silent for 2s")
        self.assertEqual(self.command("state"), "ok pre-operational, faults: silent")
        self.no_answer(POSITION, 0)
        end = time.monotonic() + PATIENCE
        while self.command("state") != "ok pre-operational" and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))

    def test_boot_up_and_heartbeat(self) -> None:
        self.begin()
        self.sdo.download(HEARTBEAT, 0, u16(50))
        self.expect_frame(BOOT_UP, b"\x7f")
        self.fault("no-heartbeat")
        self.quiet(BOOT_UP)
        self.fault("clear")
        self.expect_frame(BOOT_UP, b"\x7f")
        self.fault("no-boot-up")
        self.wire.forget()
        self.obeys("power-cycle")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.assertIsNone(self.wire.receive(BOOT_UP, SHORT))

    def test_sdo(self) -> None:
        self.begin()
        self.fault("no-sdo 6064h")
        self.no_answer(POSITION, 0)
        self.assertEqual(self.sdo.upload(STATUSWORD, 0), u16(0))
        self.fault("clear", "no-sdo")
        self.no_answer(STATUSWORD, 0)
        self.fault("clear", "sdo-delay 700ms")
        begin = time.monotonic()
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.assertGreaterEqual(time.monotonic() - begin, 0.69)
        self.fault("clear", "sdo-drop 1/2")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.no_answer(POSITION, 0)
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.fault("clear", 'abort 1018h "0800 0000h" read', "abort 6040h 08000021h write")
        for address, code in (((0x1018, 1), 0x0800_0000), ((0x1018, 2), 0x0800_0000)):
            with self.assertRaises(Abort) as refused:
                self.sdo.upload(*address)
            self.assertEqual(refused.exception.code, code)
        with self.assertRaises(Abort) as refused:
            self.sdo.download(CONTROLWORD, 0, u16(1))
        self.assertEqual(refused.exception.code, 0x0800_0021)
        self.assertEqual(self.sdo.upload(CONTROLWORD, 0), u16(0))

    def test_toggle_bit(self) -> None:
        self.begin()
        name = self.sdo.upload(0x1008, 0)
        self.assertGreater(len(name), 4)
        self.fault("sdo-toggle")
        with self.assertRaisesRegex(ValueError, "upload segment is 1"):
            self.sdo.upload(0x1008, 0)

    def test_pdos(self) -> None:
        self.begin("--start")
        self.assertEqual(len(self.wire.receive(TPDO2, PATIENCE)), 6)
        self.fault("pdo-short 2 3")
        self.wire.forget()
        self.assertEqual(len(self.wire.receive(TPDO2, PATIENCE)), 3)
        self.assertEqual(len(self.wire.receive(TPDO1, PATIENCE)), 2)
        self.fault("clear", "no-pdo 1")
        self.quiet(TPDO1)
        self.assertEqual(len(self.wire.receive(TPDO2, PATIENCE)), 6)

    def test_stuck(self) -> None:
        self.begin()
        self.obeys("set 6064h 12", "fault stuck 6064h", "fault stuck 6040h", "set 6064h 13")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(12))
        self.sdo.download(CONTROLWORD, 0, u16(15))
        self.assertEqual(self.sdo.upload(CONTROLWORD, 0), u16(0))
        self.fault("clear")
        self.sdo.download(CONTROLWORD, 0, u16(15))
        self.assertEqual(self.sdo.upload(CONTROLWORD, 0), u16(15))

    def test_twin_and_babbling(self) -> None:
        self.begin()
        self.wire.forget()
        self.fault("twin")
        self.expect_frame(BOOT_UP, b"\0")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))
        self.assertEqual(self.wire.receive(RESPONSE, PATIENCE), bytes.fromhex("43 64 60 00 00 00 00 00"))
        self.fault("clear", "babbling")
        for _ in range(50):
            self.assertEqual(self.wire.receive(EMCY, PATIENCE), bytes.fromhex("00 FF 01 00 00 00 00 00"))

    def test_lost_node_id(self) -> None:
        self.begin()
        self.wire.forget()
        self.fault("lost-node-id")
        self.assertEqual(self.command("state"), "ok no node-ID, faults: lost-node-id")
        self.assertIsNone(self.wire.receive(BOOT_UP, SHORT))
        self.no_answer(POSITION, 0)
        self.wire.send(LSS_MASTER, bytes([0x04, 0x01, 0, 0, 0, 0, 0, 0]))  # switch state global: configuration
        self.wire.send(LSS_MASTER, bytes([0x11, 9, 0, 0, 0, 0, 0, 0]))  # configure node-ID
        self.assertEqual(self.wire.receive(LSS_SLAVE, PATIENCE)[:2], bytes([0x11, 0]))
        self.wire.send(LSS_MASTER, bytes([0x04, 0x00, 0, 0, 0, 0, 0, 0]))  # waiting
        self.expect_frame(0x709, b"\0")
        self.assertEqual(SdoClient(self.wire, 9, PATIENCE).upload(POSITION, 0), i32(0))
        self.fault("clear")
        self.expect_frame(BOOT_UP, b"\0")
        self.assertEqual(self.sdo.upload(POSITION, 0), i32(0))


class Documents(Behaviour):
    """docs/simulated-nodes.md: its dialog, its list of commands, and the script of eds."""

    def blocks(self) -> list[str]:
        page = (SOURCE_DIR / "docs/simulated-nodes.md").read_text()
        return re.findall(r"<!-- run by: tests/cli/live/node_behaviour_test.py -->\n```text\n(.*?)```", page, re.DOTALL)

    def test_dialog(self) -> None:
        self.begin()
        for command, answer in re.findall(r"^> (.*)\n(.*)$", self.blocks()[0], re.MULTILINE):
            self.assertEqual(self.command(command), answer, command)

    def test_list_of_commands(self) -> None:
        self.begin()
        lines = [self.command("help")]
        while lines[-1] != "ok":
            lines.append(self.process.stdout.readline().rstrip("\n"))
        self.assertEqual("\n".join(lines[:-1]) + "\n", self.blocks()[1])

    def test_script_of_the_drive(self) -> None:
        self.begin("--script", SOURCE_DIR / "eds/cpc-tc1.behaviour.json", "--start")
        self.assertEqual(len(self.positions(10)), 10)
        self.sdo.download(CONTROLWORD, 0, u16(15))
        self.expect_upload(STATUSWORD, u16(0x237))
        self.sdo.download(0x60FF, 0, i32(77))
        self.expect_upload(0x606C, i32(77))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
