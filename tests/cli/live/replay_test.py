#!/usr/bin/env python3
"""edsc replay: a log of a generated node and an SDO client in Python, which python-can writes, replayed to simulated and to real
nodes; and the same log with one response changed.

    replay_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import re
import shutil
import struct
import subprocess
import sys
import time

import can
import jsonschema
from live import EDSC, FAILED, FINE, SHEET, SOURCE_DIR, WRONG_USAGE, LiveTest, run

sys.path.insert(0, str(SOURCE_DIR / "tests/masters"))

from sdo import Abort, SdoClient  # noqa: E402
from wire import Wire  # noqa: E402

NODE = 5
PATIENCE = 60.0
SIMULATED = f"--node={NODE}=device.eds"
SERIAL = "1018h:04"  # the generated node sets it (live_nodes.cpp), the EDS does not
RESET_NODE, START = 0x81, 0x01
END = 0x7FF  # no node sends it


def frame(can_id: int, data: str = "") -> tuple[int, bytes]:
    return can_id, bytes.fromhex(data)


def remote(can_id: int) -> tuple[int, None]:
    return can_id, None


LSS_REQUEST, LSS_RESPONSE = 0x7E5, 0x7E4
REQUEST, RESPONSE, BOOT_UP, STATE = 0x600 + NODE, 0x580 + NODE, 0x700 + NODE, 0x7F
# What the device of tests/fixtures/live_device.eds sends by CiA 301: the request, and the response or none.
VENDOR = (frame(REQUEST, "4018100100000000"), frame(RESPONSE, "43181001efcdab00"))
UNKNOWN = (frame(REQUEST, "40ff2f0000000000"), frame(RESPONSE, "80ff2f0000000206"))
READ_ONLY = (frame(REQUEST, "2f01100000000000"), frame(RESPONSE, "8001100002000106"))
NAME = (frame(REQUEST, "4002200000000000"), frame(RESPONSE, "4302200065647363"))
WRITE = (frame(REQUEST, "2b042000f4010000"), frame(RESPONSE, "6004200000000000"))
READ_BACK = (frame(REQUEST, "4004200000000000"), frame(RESPONSE, "4b042000f4010000"))
BOOT = (frame(BOOT_UP, "00"),)
RESET = (frame(0, f"81{NODE:02x}"), frame(BOOT_UP, "00"))
DIALOG = BOOT + VENDOR + UNKNOWN + READ_ONLY + NAME + WRITE + READ_BACK + RESET + VENDOR


class Replay(LiveTest):
    def setUp(self) -> None:
        super().setUp()
        shutil.copy(SHEET.with_name("live_device.options.json"), self.folder / "device.options.json")

    def log_of(self, *frames: tuple[int, bytes | None], name: str = "made.log") -> str:
        """Written by python-can, with 10 ms between the frames."""
        writer = can.CanutilsLogWriter(str(self.folder / name))
        for place, (can_id, data) in enumerate(frames):
            writer.on_message_received(can.Message(timestamp=1_700_000_000 + place / 100, arbitration_id=can_id, data=data,
                                                   is_remote_frame=data is None, dlc=1 if data is None else None,
                                                   is_extended_id=False, channel="can0"))
        writer.stop()
        return name

    def replay(self, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, "replay", *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=600)

    def expect_same(self, *arguments: object, compared: int = 1) -> None:
        result = self.replay(*arguments)
        self.assertEqual((result.returncode, result.stderr), (FINE, ""), result.stdout)
        self.assertRegex(result.stdout, r": no difference\n\Z")
        self.assertGreaterEqual(int(re.search(r"(\d+) responses? compared", result.stdout)[1]), compared)

    def differences(self, *arguments: object) -> list[dict]:
        result = self.replay(*arguments, "--format", "json")
        found = json.loads(result.stdout)
        jsonschema.validate(found, json.loads((SOURCE_DIR / "docs/schema/replay.schema.json").read_text()))
        self.assertEqual(result.returncode, FAILED if found["differences"] else FINE, result.stderr)
        return found["differences"]

    def replaced(self, old: tuple[int, bytes], new: tuple[tuple[int, bytes], ...], dialog: tuple = DIALOG) -> str:
        """The dialog with the first such frame replaced."""
        place = dialog.index(old)
        return self.log_of(*dialog[:place], *new, *dialog[place + 1:])

    def one_difference(self, log: str, *arguments: object) -> dict:
        found = self.differences(log, SIMULATED, *arguments)
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_a_dialog_of_cia_301(self) -> None:
        self.expect_same(self.log_of(*DIALOG), SIMULATED, compared=sum(one[0] in (RESPONSE, BOOT_UP) for one in DIALOG))

    def test_another_value(self) -> None:
        found = self.one_difference(self.replaced(VENDOR[1], (frame(RESPONSE, "43181001eecdab00"),)))
        self.assertEqual((found["kind"], found["service"], found["node_id"], found["index"], found["line"], found["at_us"]),
                         ("value", "sdo", NODE, "1018h:01", 3, 20_000))
        self.assertEqual((found["request"]["data"], found["expected"]["data"], found["received"]["data"]),
                         ("4018100100000000", "43181001EECDAB00", "43181001EFCDAB00"))
        self.assertRegex(found["expected"]["text"], "(?i)Vendor-ID = .*ABCDEE")
        self.assertRegex(found["received"]["text"], "(?i)Vendor-ID = .*ABCDEF")

    def test_an_expedited_value_without_its_size(self) -> None:
        self.expect_same(self.replaced(NAME[1], (frame(RESPONSE, "4202200065647363"),)), SIMULATED)
        self.assertEqual(self.one_difference(self.replaced(NAME[1], (frame(RESPONSE, "4202200065647364"),)))["kind"], "value")

    def test_another_abort_code(self) -> None:
        found = self.one_difference(self.replaced(UNKNOWN[1], (frame(RESPONSE, "80ff2f0011000906"),)))
        self.assertEqual((found["kind"], found["index"]), ("abort_code", "2FFFh:00"))
        self.assertIn("0609 0011h", found["expected"]["text"])
        self.assertIn("0602 0000h", found["received"]["text"])

    def test_an_abort_instead_of_a_value(self) -> None:
        found = self.one_difference(self.replaced(READ_BACK[1], (frame(RESPONSE, "8004200000000206"),)))
        self.assertEqual((found["kind"], found["index"]), ("abort_code", "2004h:00"))

    def test_a_missing_response(self) -> None:
        """The log has one more than the node sends."""
        found = self.one_difference(self.replaced(WRITE[1], (WRITE[1], WRITE[1])))
        self.assertEqual((found["kind"], found["received"], found["expected"]["data"]), ("missing", None, "6004200000000000"))

    def test_an_additional_response(self) -> None:
        found = self.one_difference(self.replaced(WRITE[1], ()))
        self.assertEqual((found["kind"], found["expected"], found["received"]["data"]), ("additional", None, "6004200000000000"))
        self.assertEqual(found["request"]["data"], "2B042000F4010000")

    def test_boot_up_messages(self) -> None:
        log = self.replaced(RESET[0], (frame(0, f"81{NODE + 1:02x}"),))
        self.expect_same(log, SIMULATED)  # a power-on
        found = self.one_difference(self.log_of(*BOOT, *VENDOR, RESET[0], *VENDOR))
        self.assertEqual((found["kind"], found["service"]), ("additional", "boot_up"))

    def test_an_emergency_of_the_log(self) -> None:
        found = self.one_difference(self.log_of(*BOOT, *VENDOR, frame(0x080 + NODE, "3043090000000000"), *VENDOR))
        self.assertEqual((found["kind"], found["service"], found["line"]), ("missing", "emcy", 4))
        self.assertIn("4330h", found["expected"]["text"])

    def test_pdos(self) -> None:
        """TPDO 1 is 6041h and 6064h, RPDO 1 is 6040h and 60FFh; both are event-driven, which has an initial TPDO."""
        started = BOOT + (frame(0, f"01{NODE:02x}"), frame(0x180 + NODE, "500240e20100"), frame(0x200 + NODE, "0f0007000000"),
                          frame(REQUEST, "4040600000000000"), frame(RESPONSE, "4b4060000f000000"))
        self.expect_same(self.log_of(*started), SIMULATED, "--pdos")
        log = self.replaced(frame(0x180 + NODE, "500240e20100"), (frame(0x180 + NODE, "510240e20100"),), started)
        self.expect_same(log, SIMULATED)
        found = self.one_difference(log, "--pdos")
        self.assertEqual((found["kind"], found["service"]), ("content", "tpdo"))
        self.assertIn("Statusword", found["received"]["text"])

    def test_node_guarding(self) -> None:
        """CiA 301, 7.2.8.3.1: the state, and a bit that changes with each response, 0 in the first one."""
        guarded = BOOT + (remote(BOOT_UP), frame(BOOT_UP, "7f"), remote(BOOT_UP), frame(BOOT_UP, "ff"))
        device = f"--node={NODE}={SOURCE_DIR / 'eds/can-2053c.eds'}"
        self.expect_same(self.log_of(*guarded), device, compared=3)
        (found,) = self.differences(self.log_of(*guarded[:-1], frame(BOOT_UP, "7f")), device)
        self.assertEqual((found["kind"], found["service"], found["expected"]["data"], found["received"]["data"]),
                         ("content", "guarding", "7F", "FF"))

    def test_lss(self) -> None:
        """CiA 305: configuration state for all, then the vendor-ID, which is in the EDS."""
        asked = BOOT + (frame(LSS_REQUEST, "0401000000000000"), frame(LSS_REQUEST, "5a00000000000000"))
        self.expect_same(self.log_of(*asked, frame(LSS_RESPONSE, "5aefcdab00000000")), SIMULATED, compared=2)
        found = self.one_difference(self.log_of(*asked, frame(LSS_RESPONSE, "5aeecdab00000000")))
        self.assertEqual((found["kind"], found["service"], found["node_id"], found["request"]["data"]),
                         ("content", "lss", None, "5A00000000000000"))

    def test_two_nodes(self) -> None:
        other = NODE + 1
        of_other = tuple((can_id + 1, data) for can_id, data in BOOT + VENDOR + UNKNOWN)
        nodes = (SIMULATED, f"--node={other}=device.eds")
        self.expect_same(self.log_of(*BOOT, *of_other, *VENDOR), *nodes, compared=5)
        wrong = self.log_of(*BOOT, *of_other[:2], frame(0x580 + other, "43181001eecdab00"), *VENDOR)
        self.assertEqual([(one["node_id"], one["kind"]) for one in self.differences(wrong, *nodes)], [(other, "value")])

    def test_ignored_objects(self) -> None:
        log = self.replaced(VENDOR[1], (frame(RESPONSE, "43181001eecdab00"),))
        for name in ("1018h:01", "1018h", "Vendor-ID", "identity_object"):
            self.expect_same(log, SIMULATED, "--ignore", name)
        self.assertEqual(len(self.differences(log, SIMULATED, "--ignore", "1018h:02")), 1)
        refused = self.replay(log, SIMULATED, "--ignore", "no_such")
        self.assertEqual(refused.returncode, WRONG_USAGE)
        self.assertIn("no_such", refused.stderr)

    def test_all_differences(self) -> None:
        log = self.log_of(*BOOT, VENDOR[0], frame(RESPONSE, "43181001eecdab00"), UNKNOWN[0], frame(RESPONSE, "80ff2f0011000906"), *WRITE)
        self.assertEqual([one["kind"] for one in self.differences(log, SIMULATED)], ["value"])
        self.assertEqual([one["kind"] for one in self.differences(log, SIMULATED, "--all-differences")], ["value", "abort_code"])

    def test_text(self) -> None:
        log = self.replaced(VENDOR[1], (frame(RESPONSE, "43181001eecdab00"),))
        result = self.replay(log, SIMULATED)
        self.assertEqual(result.returncode, FAILED)
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0], "made.log:3: 0.020000 s: node 5, SDO 1018h:01: the response differs")
        self.assertRegex(lines[1], r"\A    request   605 40 18 10 01 00 00 00 00  read 1018h:01 .*Vendor-ID\Z")
        self.assertRegex(lines[2], r"\A    expected  585 43 18 10 01 EE CD AB 00  .*Vendor-ID = ")
        self.assertRegex(lines[3], r"\A    received  585 43 18 10 01 EF CD AB 00  .*Vendor-ID = ")
        self.assertRegex(lines[4], r"\Amade.log: \d+ frames? sent to 1 node, \d+ responses? compared: 1 difference\Z")

    def record(self) -> str:
        """What an SDO client in Python and the generated node send."""
        recorder = self.network.client()
        wire = Wire(self.network.address)
        self.addCleanup(wire.close)
        sdo = SdoClient(wire, NODE, PATIENCE)
        wire.send(0, bytes([RESET_NODE, NODE]))
        self.assertEqual(wire.receive(BOOT_UP, PATIENCE), b"\0")
        for sub_index in range(5):
            sdo.upload(0x1018, sub_index)
        sdo.upload(0x1008, 0)
        sdo.download(0x1017, 0, struct.pack("<H", 50))
        while wire.receive(BOOT_UP, PATIENCE) != bytes([STATE]):  # the boot-up message of power-on may be there, too
            pass
        with self.assertRaises(Abort):
            sdo.download(0x1018, 1, bytes(4))
        sdo.download(0x2002, 0, b"a longer text")
        self.assertEqual(sdo.upload(0x2002, 0), b"a longer text")
        wire.send(0, bytes([START, NODE]))
        wire.receive(0x180 + NODE, PATIENCE)
        wire.send(0x200 + NODE, struct.pack("<Hi", 0x0F, -7))
        while sdo.upload(0x60FF, 0) != struct.pack("<i", -7):
            time.sleep(0.01)
        wire.send(END)
        writer = can.CanutilsLogWriter(str(self.folder / "recorded.log"))
        while True:
            kind, can_id, seconds, *data = recorder.message().split()
            if int(can_id, 16) == END:
                break
            self.assertEqual(kind, "frame")
            writer.on_message_received(can.Message(timestamp=float(seconds), arbitration_id=int(can_id, 16), is_extended_id=False,
                                                   data=bytes.fromhex("".join(data)), channel="can0"))
        writer.stop()
        return "recorded.log"

    def test_a_recorded_log(self) -> None:
        log = self.record()
        text = (self.folder / log).read_text()
        responses = text.count(" 585#")
        self.assertGreater(responses, 15)
        self.expect_same(log, SIMULATED, "--ignore", SERIAL, compared=responses)  # and the boot-up message in place of the ignored one
        self.expect_same(log, self.network.address, compared=responses + 1)
        self.expect_same(self.network.address, log, SIMULATED, "--speed", 1000, compared=responses + 1)
        (self.folder / log).write_text(text.replace("605#4018100200000000", "605#4018100300000000"))
        found = self.differences(log, self.network.address)
        self.assertEqual([(one["kind"], one["index"], one["expected"]["data"][:8], one["received"]["data"][:8]) for one in found],
                         [("value", "1018h:03", "43181002", "43181003")])

    def test_a_node_that_does_not_answer(self) -> None:
        log = self.log_of(frame(0x609, "4018100100000000"), frame(0x589, "43181001efcdab00"))
        found = self.differences(log, self.network.address, "--timeout", "50ms")
        self.assertEqual([(one["kind"], one["node_id"]) for one in found], [("missing", 9)])

    def test_a_clock_that_was_set(self) -> None:
        """From 1970 on; the times of differences remain those of the log."""
        (self.folder / "jump.log").write_text(
            "(10.0) can0 705#00\n(1764300000.0) can0 605#4018100100000000\n(1764300000.1) can0 585#43181001EECDAB00\n")
        began = time.monotonic()
        result = self.replay("jump.log", SIMULATED, "--format", "json")
        self.assertLess(time.monotonic() - began, PATIENCE / 2)
        self.assertEqual(result.stderr, "edsc: jump.log:2: 1764299990 s: no frame for 1764299990 s before this one; "
                                        "the replay takes 120 s for it\n")
        self.assertEqual([(one["line"], one["at_us"]) for one in json.loads(result.stdout)["differences"]], [(3, 1_764_299_990_100_000)])

    def test_nothing_is_compared(self) -> None:
        log = self.log_of(*DIALOG, frame(0x709, "05"))
        result = self.replay(log, f"--node={NODE + 1}=device.eds")
        self.assertEqual(result.returncode, FAILED)
        self.assertRegex(result.stdout, r"0 responses compared: no result\n\Z")
        self.assertEqual(result.stderr, "edsc: made.log: nothing was compared with node 6; the log has frames of nodes 5, 9\n")
        result = self.replay(self.log_of(frame(0x080)), SIMULATED, "--format", "json")
        self.assertEqual((result.returncode, json.loads(result.stdout)["compared"]), (FAILED, 0))
        self.assertIn("no node sends frames in the log", result.stderr)

    def test_wrong_usage(self) -> None:
        log = self.log_of(*DIALOG)
        for arguments, message in (((log,), "TARGET"), ((log, "can0"), "can0"), ((), "LOG is required")):
            result = self.replay(*arguments)
            self.assertEqual((result.returncode, message in result.stderr), (WRONG_USAGE, True), result.stderr)


if __name__ == "__main__":
    run()
