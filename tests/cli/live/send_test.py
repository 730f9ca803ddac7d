#!/usr/bin/env python3
"""edsc send with a live node on the virtual bus of `edsc bus`. The expected frames follow CiA 301 and the device's EDS.

    send_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import signal
import time
from datetime import UTC, datetime, timedelta

from live import FINE, INTERRUPTED, SHEET, WRONG_USAGE, LiveTest, run

NODE = (5, "--eds", "device.eds")
TIME_EPOCH = datetime(1984, 1, 1, tzinfo=UTC)  # CiA 301, 7.1.6.6


def time_frame(moment: datetime) -> str:
    """Milliseconds after midnight in 28 bits and days in 16 bits, little-endian."""
    since = moment - TIME_EPOCH
    milliseconds = (since - timedelta(days=since.days)) // timedelta(milliseconds=1)
    return "100 " + (milliseconds.to_bytes(4, "little") + since.days.to_bytes(2, "little")).hex(" ").upper()


class Send(LiveTest):
    def test_sync_with_a_counter_that_overflows(self) -> None:
        self.expect(self.edsc("send", "sync", "--overflow", 3, "--every", "1ms", "--count", 5), FINE)
        self.expect(self.edsc("send", "sync", "--id", "81h"), FINE)
        self.assertEqual(self.network.frames("080", "081"), ["080 01", "080 02", "080 03", "080 01", "080 02", "081"])

    def test_sync_until_ctrl_c(self) -> None:
        process = self.start("send", "sync", "--every", "2ms")
        while len([frame for frame in self.network.log if frame == "080"]) < 20:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.communicate(timeout=600)[1], "edsc: interrupted\n")
        self.assertEqual(process.returncode, INTERRUPTED)

    def test_the_period_does_not_drift(self) -> None:
        """A process that waits for a period after each frame needs longer."""
        begin = time.monotonic()
        self.expect(self.edsc("send", "sync", "--every", "20ms", "--count", 50), FINE)
        self.assertGreaterEqual(time.monotonic() - begin, 0.98)
        self.assertEqual(len(self.network.frames("080")), 50)

    def test_time(self) -> None:
        self.expect(self.edsc("send", "time", "2026-01-31 12:00:00"), FINE)
        before = datetime.now(UTC) - timedelta(milliseconds=1)
        self.expect(self.edsc("send", "time"), FINE)
        after = datetime.now(UTC)
        first, second = self.network.frames("100")
        self.assertEqual(first, time_frame(datetime(2026, 1, 31, 12, tzinfo=UTC)))
        data = bytes.fromhex(second[4:])
        sent = TIME_EPOCH + timedelta(milliseconds=int.from_bytes(data[:4], "little"), days=int.from_bytes(data[4:], "little"))
        self.assertLessEqual(before, sent)
        self.assertLessEqual(sent, after)

    def test_the_node_takes_the_values_of_an_rpdo(self) -> None:
        self.expect(self.edsc("nmt", "start", 5), FINE)
        self.expect(self.edsc("send", "pdo", *NODE, 1, "target_velocity=-2 inc/s", "6040h=0x0F"), FINE)
        self.expect(self.edsc("read", 5, "6040h", "60FFh", "--eds", "device.eds", "--raw"), FINE,
                    stdout="6040h:00 Controlword = 0F 00\n60FFh:00 Target velocity = FE FF FF FF\n")
        self.assertEqual(self.network.frames("205"), ["205 0F 00 FE FF FF FF"])

    def test_values_by_name_and_unit(self) -> None:
        self.expect(self.edsc("send", "pdo", *NODE, 1, "target_velocity=100 inc/s", "controlword=enable_operation, halt"), FINE)
        self.assertEqual(self.network.frames("205"), ["205 0F 01 64 00 00 00"])
        result = self.edsc("send", "pdo", *NODE, 1, "target_velocity=1", "controlword=enable_operations")
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertIn('"enable_operations" is not a field or value; did you mean "enable_operation"?', result.stderr)

    def test_a_tpdo_in_place_of_the_node(self) -> None:
        self.expect(self.edsc("send", "pdo", *NODE, 1, "statusword=0x27", "6064h=-1", "--tpdo"), FINE)
        self.assertEqual(self.network.frames("185")[-1], "185 27 00 FF FF FF FF")

    def test_a_pdo_on_the_can_id_of_the_file(self) -> None:
        text = SHEET.read_text()
        (self.folder / "other.eds").write_text(text.replace("DefaultValue=$NODEID+0x200", "DefaultValue=0x333"))
        self.expect(self.edsc("send", "pdo", 5, "--eds", "other.eds", 1, "6040h=6", "60FFh=1"), FINE)
        self.assertEqual(self.network.frames("333"), ["333 06 00 01 00 00 00"])

    def test_a_pdo_as_the_network_file_configures_it(self) -> None:
        """RPDO 1 of the file maps 6040h and 60FFh; `set` makes it 6040h alone, on another CAN-ID."""
        (self.folder / "device.json").write_text(json.dumps({"bit_rate": 500, "nodes": {"axis1": {
            "node_id": 5, "eds": "device.eds",
            "set": {"1400h:01": "0x345", "1600h:00": 1, "1600h:01": "0x60400010"}}}}))
        for node in ("axis1", 5):
            self.expect(self.edsc("send", "pdo", node, 1, "6040h=6", "--network", "device.json"), FINE)
        self.expect(self.edsc("send", "pdo", *NODE, 1, "6040h=6", "60FFh=0", "--network", "device.json"), FINE)
        self.assertEqual(self.network.frames("345", "205"), ["345 06 00", "345 06 00", "205 06 00 00 00 00 00"])
        self.expect(self.edsc("send", "pdo", "axis1", 99, "--network", "device.json"), WRONG_USAGE,
                    stderr="edsc: node axis1 of device.json does not have RPDO 99\n")

    def test_frames(self) -> None:
        for frame in ("181#0102", "18FF0001#AA", "701#R1"):
            self.expect(self.edsc("send", "frame", frame), FINE)
        self.assertEqual(self.network.frames("181", "18FF0001", "701"), ["181 01 02", "18FF0001 AA", "701 R1"])

    def test_values_that_are_refused(self) -> None:
        for arguments, problem in (
                ((1, "6040h=1"), "edsc: missing value of 60FFh:00 Target velocity\n"),
                ((1, "6040h=1", "60FFh=1", "6041h=1"), "edsc: RPDO 1 does not map 6041h:00\n"),
                ((1, "6040h=1", "60FFh=1", "controlword=2"), "edsc: 6040h:00 has two values\n"),
                ((1, "6040h", "60FFh=1"), 'edsc: "6040h" is not of the form OBJECT=VALUE\n'),
                ((99,), "edsc: device.eds does not have RPDO 99\n")):
            with self.subTest(arguments):
                self.expect(self.edsc("send", "pdo", *NODE, *arguments), WRONG_USAGE, stderr=problem)
        result = self.edsc("send", "pdo", *NODE, 1, "6040h=65536", "60FFh=1")
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertRegex(result.stderr, "^edsc: 6040h:00 Controlword: .*65536")
        self.assertEqual(self.network.frames("205"), [])

    def test_wrong_usage(self) -> None:
        for arguments in ((), ("sync", "--overflow", 241), ("sync", "--every", "0ms"), ("frame", "181"), ("frame", "181#0"),
                          ("pdo", "device.eds", 1), ("time", "yesterday"), ("time", "")):
            with self.subTest(arguments):
                result = self.edsc("send", *arguments)
                self.assertEqual(result.returncode, WRONG_USAGE, result.stderr)

    def test_numbers_that_cannot_be_meant(self) -> None:
        for arguments, problem in ((("sync", "--count", 0), 'edsc: --count: "0" is not a number from 1\n'),
                                   (("sync", "--id", 0), 'edsc: --id: "0" is not a CAN-ID up to 1FFFFFFFh, or is reserved by CiA 301\n'),
                                   (("time", "--id", "705h"), 'edsc: --id: "705h" is not a CAN-ID')):
            with self.subTest(arguments):
                result = self.edsc("send", *arguments)
                self.assertEqual(result.returncode, WRONG_USAGE)
                self.assertTrue(result.stderr.startswith(problem), result.stderr)
        self.assertEqual(self.network.frames("000", "705"), ["705 00"])


if __name__ == "__main__":
    run()
