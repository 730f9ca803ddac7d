#!/usr/bin/env python3
"""edsc write with live nodes on the virtual bus of `edsc bus`.

    write_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import subprocess

from live import EDSC, FAILED, FINE, PATIENCE_MS, WRONG_USAGE, LiveTest, run


class Write(LiveTest):
    def without_bus(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([EDSC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)

    def test_with_the_unit_and_read_back(self) -> None:
        self.expect(self.edsc("write", 5, "speed", "1500 rpm", "--eds", "device.eds", "--verify"), FINE,
                    "2004h:00 Speed = 1500 rpm, verified\n")
        self.expect(self.edsc("write", 5, "label", "left axis", "--eds", "device.eds"), FINE, '2002h:00 Label = "left axis"\n')
        self.expect(self.edsc("read", 5, "label", "speed", "--eds", "device.eds"), FINE,
                    '2002h:00 Label = "left axis"\n2004h:00 Speed = 1500 rpm\n')

    def test_a_value_in_the_unit_of_a_scaled_entry_is_converted(self) -> None:
        """One step of 2004h is 0.1 rpm, one of 60FFh is 100 inc/s, in each command that takes or shows a value."""
        text = (self.folder / "device.eds").read_text()
        scaled = text.replace("DefaultValue=1000\nPDOMapping=0\nUnit=rpm", "DefaultValue=1000\nPDOMapping=0\nUnit=rpm\nFactor=0.1")
        scaled = scaled.replace("Unit=inc/s", "Unit=inc/s\nFactor=100")
        self.assertEqual(scaled.count("Factor="), 2)
        (self.folder / "device.eds").write_text(scaled)
        for text, raw in (("150 rpm", 1500), ("2.5 rev/s", 1500), ("1500", 1500), ("-0.1 rpm", None)):
            with self.subTest(text):
                done = self.edsc("write", 5, "speed", "--eds", "device.eds", "--verify", "--timeout", f"{PATIENCE_MS}ms", "--", text)
                if raw is None:
                    self.expect(done, WRONG_USAGE, stderr='edsc: -0.1 rpm is outside the range of UNSIGNED16: 2004h:00 "Speed"\n')
                else:
                    self.expect(done, FINE, "2004h:00 Speed = 150 rpm, verified\n")
        self.expect(self.edsc("write", 5, "speed", "150 rpm", "--eds", "device.eds", "--force"), FINE, "2004h:00 Speed = 150 rpm\n")
        self.expect(self.edsc("write", 5, "speed", "150.05 rpm", "--eds", "device.eds"), WRONG_USAGE,
                    stderr='edsc: 150.05 rpm is between 150 rpm and 150.1 rpm: 2004h:00 "Speed"\n')
        self.expect(self.edsc("write", 5, "speed", "5 V", "--eds", "device.eds"), WRONG_USAGE,
                    stderr='edsc: V cannot be converted to rpm: 2004h:00 "Speed"\n')
        self.expect(self.edsc("send", "pdo", 5, "--eds", "device.eds", 1, "60FFh=250 inc/s", "6040h=0"), WRONG_USAGE,
                    stderr="edsc: 60FFh:00 Target velocity: 250 inc/s is between 200 inc/s and 300 inc/s: "
                           '60FFh:00 "Target velocity"\n')
        self.expect(self.edsc("read", 5, "speed", "--eds", "device.eds"), FINE, "2004h:00 Speed = 150 rpm\n")
        read = self.expect_json(self.edsc("read", 5, "speed", "--eds", "device.eds", "--format", "json"), "read.schema.json")
        entry = read["entries"][0]
        self.assertEqual((entry["value"], entry["physical"], entry["unit"], entry["text"]), (1500, 150, "rpm", "150 rpm"))
        written = [frame for frame in self.network.frames("605") if frame.startswith("605 2B")]
        self.assertEqual(written, 4 * ["605 2B 04 20 00 DC 05 00 00"])
        (self.folder / "bus.log").write_text("(1.0) can0 205#0F00FEFFFFFF\n(2.0) can0 605#2B042000E8030000\n")
        for form, values in (("text", ("Target velocity = -200 inc/s", "Speed = 100 rpm")),
                             ("json", ("Target velocity = -200 inc/s", "Speed = 100 rpm")),
                             ("csv", ("Target velocity,-2,-200,inc/s,", "Speed,1000,100,rpm,"))):
            with self.subTest(form):
                shown = self.without_bus("decode", "--format", form, "--node", "5=device.eds", "bus.log").stdout
                for value in values:
                    self.assertIn(value, shown)
        plot = self.without_bus("plot", "bus.log", "60FFh", "--node", "5=device.eds").stdout
        self.assertIn("Target velocity", plot)
        self.assertIn("inc/s", plot)
        (self.folder / "set.dcf").write_text(scaled.replace("DefaultValue=1000\n", "DefaultValue=1000\nParameterValue=5 rpm\n"))
        self.assertNotEqual(self.without_bus("check", "set.dcf").returncode, FINE)

    def test_a_value_in_brackets_is_no_list(self) -> None:
        self.expect(self.edsc("write", 5, "label", "--eds", "device.eds", "--timeout", f"{PATIENCE_MS}ms", "--", "[a,b]"), FINE, '2002h:00 Label = "[a,b]"\n')
        self.expect(self.edsc("write", 5, "label", "[a]", "[b]", "--eds", "device.eds"), FINE, '2002h:00 Label = "[a] [b]"\n')

    def test_without_a_data_sheet(self) -> None:
        self.expect(self.edsc("write", 5, "1017h", "500", "--type", "u16"), FINE, "1017h:00 = 500 (01F4h)\n")
        self.expect(self.edsc("write", 5, "1017h", "--raw", "F4", "01"), FINE, "1017h:00 = F4 01\n")
        self.assertEqual(self.network.frames("605"), ["605 2B 17 10 00 F4 01 00 00"] * 2)

    def test_limits_are_looked_at_first(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds"), WRONG_USAGE,
                    stderr='edsc: 6001 is above the high limit of 2005h:00 "Maximum speed", 6000\n')
        self.expect(self.edsc("write", 5, "1008h", "other", "--eds", "device.eds"), WRONG_USAGE,
                    stderr="edsc: 1008h:00 Manufacturer device name is const; not written (--force writes anyway)\n")
        self.assertEqual(self.network.frames("605"), [])

    def test_force_leaves_them_to_the_device(self) -> None:
        self.expect(self.edsc("write", 5, "maximum_speed", 6001, "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 2005h:00 Maximum speed: refused by the device: 0609 0031h, value too high\n")
        self.expect(self.edsc("write", 5, "1008h", "x", "--eds", "device.eds", "--force"), FAILED,
                    stderr="edsc: 1008h:00 Manufacturer device name: refused by the device: 0601 0002h, write of a read-only object\n")

    def test_a_value_that_reads_back_as_another(self) -> None:
        self.expect(self.edsc("write", 5, "rounded_value", 15, "--eds", "device.eds", "--verify"), FAILED,
                    stderr="edsc: 2009h:00 Rounded value: written, but it reads back as 10 (000Ah)\n")

    def test_a_domain_from_a_file_by_block_transfer(self) -> None:
        content = bytes(i % 251 for i in range(5000))
        (self.folder / "firmware.bin").write_bytes(content)
        self.expect(self.edsc("write", 5, "firmware", "--file", "firmware.bin", "--eds", "device.eds"), FINE,
                    "2000h:00 Firmware: 5000 bytes from firmware.bin\n")
        self.edsc("read", 5, "log", "--eds", "device.eds", "--output", "back.bin")
        self.assertEqual((self.folder / "back.bin").read_bytes(), content)
        self.assertEqual(self.network.frames("605")[0], "605 C6 00 20 00 88 13 00 00")

    def test_a_file_without_an_eds_is_not_echoed(self) -> None:
        (self.folder / "firmware.bin").write_bytes(bytes(1000))
        self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin"), FINE, "2000h:00: 1000 bytes from firmware.bin\n")

    def test_by_segments_when_asked(self) -> None:
        (self.folder / "firmware.bin").write_bytes(bytes(range(200)))
        self.expect(self.edsc("write", 5, "2000h", "--file", "firmware.bin", "--segmented"), FINE,
                    "2000h:00: 200 bytes from firmware.bin\n")
        self.expect(self.edsc("read", 5, "2001h", "--output", "back.bin", "--eds", "device.eds", "--segmented"), FINE,
                    "2001h:00 Log: 200 bytes to back.bin\n")
        self.assertEqual((self.folder / "back.bin").read_bytes(), bytes(range(200)))
        self.assertEqual([frame[:15] for frame in self.network.frames("605") if frame[7:15] in ("00 20 00", "01 20 00")],
                         ["605 21 00 20 00", "605 40 01 20 00"])

    def test_wrong_usage(self) -> None:
        for arguments, words in (
                (("1017h",), "VALUE or --file"),
                (("1017h", "5"), "requires a type"),
                (("1017h", "x", "--type", "u16"), "is not a number"),
                (("1017h", "70000", "--type", "u16"), "does not fit into UNSIGNED16"),
                (("1018h", "1", "--eds", "device.eds"), "1018h"),
                (("firmware", "--file", "missing", "--eds", "device.eds"), "missing: No such file"),
                (("firmware", "--file", ".", "--eds", "device.eds"), "edsc: .: Is a directory")):
            with self.subTest(arguments=arguments):
                result = self.edsc("write", 5, *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


if __name__ == "__main__":
    run()
