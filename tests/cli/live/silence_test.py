#!/usr/bin/env python3
"""edsc read and write with devices and buses that break the protocol or no longer respond, on the bus of `edsc bus`.

    silence_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import signal
import subprocess

from live import ABORT_GENERAL, EDSC, FAILED, FINE, INTERRUPTED, LIVE_NODES, SHEET, LiveTest, entry, run
from network import Network

HISTORY = ("\n[1003]\nParameterName=Pre-defined error field\nObjectType=8\nSubNumber=3\n" +
           entry("1003sub0", "Number of errors", 5, "rw", 0) + entry("1003sub1", "Error 1", 7, "ro", 0) +
           entry("1003sub2", "Error 2", 7, "ro", 0) +
           "\n[2010]\nParameterName=Log\nObjectType=8\nSubNumber=3\n" + entry("2010sub0", "Number", 5, "ro", 2) +
           entry("2010sub1", "Row 1", 7, "ro", 0) + entry("2010sub2", "Row 2", 7, "ro", 0))


class Silence(LiveTest):
    """Devices and buses that no longer respond."""
    nodes = ()

    def wait_for(self, process: subprocess.Popen[str]) -> tuple[int, str, str]:
        return process.wait(timeout=600), process.stdout.read(), process.stderr.read()

    def test_ctrl_c_aborts_the_transfer(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", "600000ms")
        self.assertEqual(asked.receive(), "605 40 17 10 00 00 00 00 00")
        process.send_signal(signal.SIGINT)
        self.assertEqual(self.wait_for(process), (INTERRUPTED, "", "edsc: interrupted\n"))
        self.assertEqual(self.network.frames(), ["605 40 17 10 00 00 00 00 00", ABORT_GENERAL])

    def test_the_bus_goes_away(self) -> None:
        asked = self.network.client()
        process = self.start("read", 5, "1017h", "--timeout", "600000ms")
        asked.receive()
        self.network.bus.kill()
        exit_code, stdout, stderr = self.wait_for(process)
        self.assertEqual((exit_code, stdout), (FAILED, ""))
        self.assertIn(": the bus is lost: ", stderr)

    def test_a_device_that_falls_silent_in_the_middle(self) -> None:
        answers = {"605 40 08 10 00 00 00 00 00": ["585 41 08 10 00 0B 00 00 00"]}
        self.network.device(lambda frame: answers.get(frame, []))
        self.expect(self.edsc("read", 5, "1008h", "--timeout", "50ms"), FAILED, stderr="edsc: 1008h:00: no answer within 50 ms\n")
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
        self.expect(self.edsc("read", 5, "1017h", "--timeout", "5000ms"), FAILED,
                    stderr="edsc: 1017h:00: no answer within 5000 ms, but an abort of 0000h:00: 0504 0005h, out of memory\n")

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
                ("585 80 00 00 00 03 00 04 05", "refused by the device: 0504 0003h, invalid sequence number"),
                ("585 80 00 20 00 04 00 04 05", "refused by the device: 0504 0004h, CRC error"),
                ("", "no answer within 5000 ms")):
            with self.subTest(end_of_block), Network(EDSC, LIVE_NODES) as network:
                self.network = network
                received = bytearray()
                network.device(device(end_of_block, received))
                self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin", "--timeout", "5000ms"), FINE,
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
1003h:01 Pre-defined error field, Error 1 = 00002310h continuous over-current
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
                self.expect(self.edsc("read", 5, "log", "--eds", "device.eds", "--timeout", "5000ms"), FINE,
                            "2001h:00 Log = 01 02 03 04 05 06 07 08 09 (9 bytes)\n")


if __name__ == "__main__":
    run()
