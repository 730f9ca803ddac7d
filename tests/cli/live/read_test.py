#!/usr/bin/env python3
"""edsc read with live nodes on the virtual bus of `edsc bus`.

    read_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import shutil

from live import FAILED, FINE, SHEET, WRONG_USAGE, LiveTest, run


class Read(LiveTest):
    def test_by_name_with_unit(self) -> None:
        self.expect(self.edsc("read", 5, "position_actual_value", "2007h", "--eds", "device.eds"), FINE, """\
6064h:00 Position actual value = 123456 inc
2007h:00 Temperature = -12
""")

    def test_all_entries_of_an_object(self) -> None:
        self.expect(self.edsc("read", 5, "1018h", "--eds", "device.eds"), FINE, """\
1018h:00 Identity object, Highest sub-index supported = 4
1018h:01 Identity object, Vendor-ID = 00ABCDEFh
1018h:02 Identity object, Product code = 00001001h
1018h:03 Identity object, Revision number = 00010002h
1018h:04 Identity object, Serial number = 00000100h
""")

    def test_without_a_data_sheet(self) -> None:
        self.expect(self.edsc("read", 5, "1018h:01", "0x1008"), FINE,
                    "1018h:01 = EF CD AB 00\n1008h:00 = 4C 69 76 65 20 64 65 76 69 63 65\n")
        self.expect(self.edsc("read", 5, "1018h:01", "--type", "u32"), FINE, "1018h:01 = 11259375 (00ABCDEFh)\n")
        self.expect(self.edsc("read", 5, "speed"), WRONG_USAGE,
                    stderr='edsc: "speed" is not an address such as 1018h:01; names require an EDS (--eds)\n')

    def test_fields_of_a_mode(self) -> None:
        """Bit 4 of 6040h is named by the value of 2007h, which is -12; the command reads 2007h once."""
        shutil.copy(SHEET, self.folder / "modes.eds")
        cases = {"-12": {"name": "winter", "bits": {"4": "heat", "8": "halt"}}, "0": {"bits": {"4": "cool"}}}
        word = {"bits": {"0": "lamp"}, "depends_on": "2007h", "cases": cases}
        (self.folder / "modes.options.json").write_text(json.dumps({"meaning": {"6040h": word, "6041h": word}}))
        self.assertEqual(self.edsc("write", 5, "6040h", "1100h", "--eds", "modes.eds").returncode, FINE)
        self.assertEqual(self.edsc("write", 5, "6040h", "lamp, heat", "--eds", "modes.eds").returncode, FINE)
        self.expect(self.edsc("read", 5, "6040h", "6041h", "--eds", "modes.eds"), FINE, """\
6040h:00 Controlword = 0011h disable_voltage, lamp, heat
6041h:00 Statusword = 0250h switch_on_disabled, heat
""")
        self.expect(self.edsc("read", 5, "6040h", "--eds", "modes.eds", "--raw"), FINE, "6040h:00 Controlword = 11 00\n")
        read = self.expect_json(self.edsc("read", 5, "6040h", "--eds", "modes.eds", "--format", "json"), "read.schema.json")
        self.assertEqual(read["entries"][0]["fields"], {"command": "disable_voltage", "lamp": True, "heat": True, "halt": False})
        requests = [frame[4:12] for frame in self.network.frames("605") if frame.startswith("605 40")]
        self.assertEqual(requests, ["40 40 60", "40 07 20", "40 41 60", "40 40 60", "40 40 60", "40 07 20"])

    def test_what_the_device_refuses(self) -> None:
        self.expect(self.edsc("read", 5, "2FFFh", "6064h"), FAILED, "6064h:00 = 40 E2 01 00\n",
                    "edsc: 2FFFh:00: refused by the device: 0602 0000h, object does not exist\n")
        self.expect(self.edsc("read", 5, "2006h"), FAILED,
                    stderr="edsc: 2006h:00: refused by the device: 0601 0001h, read of a write-only object\n")

    def test_a_node_that_is_not_there(self) -> None:
        self.expect(self.edsc("read", 9, "1018h:01", "1018h:02", "--timeout", "50ms"), FAILED,
                    stderr="edsc: 1018h:01: no answer within 50 ms\nedsc: node 9 does not answer: 1 more not read\n")

    def test_all_as_json(self) -> None:
        found = self.expect_json(self.edsc("read", 5, "--all", "--eds", "device.eds", "--format", "json"), "read.schema.json")
        values = {(int(entry["index"][:4], 16), int(entry["index"][6:], 16)): entry["value"] for entry in found["entries"]}
        self.assertEqual(values[0x6064, 0], 123456)
        self.assertEqual(values[0x2007, 0], -12)
        self.assertEqual(values[0x2003, 0], 1.5)
        self.assertEqual(values[0x2002, 0], "edsc")
        self.assertEqual(values[0x1800, 1], 0x185)
        self.assertNotIn((0x2001, 0), values)  # a DOMAIN
        self.assertNotIn((0x2006, 0), values)  # wo

    def test_a_refusal_as_json(self) -> None:
        found = self.expect_json(self.edsc("read", 5, "2FFFh", "--format", "json"), "read.schema.json", FAILED)
        self.assertEqual(found["entries"], [{
            "index": "2FFFh:00", "name": None, "type": None, "result": "refused",
            "abort_code": 0x06020000, "text": "refused by the device: 0602 0000h, object does not exist"}])

    def test_a_domain_goes_to_a_file_by_block_transfer(self) -> None:
        self.expect(self.edsc("read", 5, "log", "--eds", "device.eds", "--output", "log.bin"), FINE,
                    "2001h:00 Log: 3000 bytes to log.bin\n")
        self.assertEqual((self.folder / "log.bin").read_bytes(), b"\xA5" * 3000)
        self.assertEqual(self.network.frames("605")[0], "605 A4 01 20 00 7F 1C 00 00")

    def test_a_domain_on_the_screen(self) -> None:
        result = self.edsc("read", 5, "log", "--eds", "device.eds")
        self.assertEqual(result.stdout, "2001h:00 Log = " + "A5 " * 32 + "... (3000 bytes)\n")

    def test_wrong_usage(self) -> None:
        for arguments, words in (
                (("5",), "OBJECT or --all"),
                (("200", "1000h"), "not a node-ID"),
                (("5", "--all"), "--eds"),
                (("5", "1000h", "--eds", "missing.eds"), "missing.eds"),
                (("5", "speeed", "--eds", "device.eds"), "speed"),
                (("5", "1018h", "--eds", "device.eds", "--output", "x"), "one entry, not of 5")):
            with self.subTest(arguments=arguments):
                result = self.edsc("read", *arguments)
                self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
                self.assertIn(words, result.stderr)


if __name__ == "__main__":
    run()
