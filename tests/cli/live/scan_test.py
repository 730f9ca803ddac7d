#!/usr/bin/env python3
"""edsc scan with live nodes on the virtual bus of `edsc bus`.

    scan_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import re
import subprocess

from live import EDSC, FAILED, FINE, SHEET, WRONG_USAGE, LiveTest, run


class Scan(LiveTest):
    nodes = (5, 6)
    fast = ("--timeout", "5000ms", "--for", "100ms")
    some = ("--nodes", "1..16")  # all are queried at the same time

    def test_it_tells_who_is_there(self) -> None:
        self.expect(self.edsc("scan", *self.some, *self.fast), FINE, """\
node  state  vendor-ID  product    revision   serial     device type                                   name
   5  -      00ABCDEFh  00001001h  00010002h  00000100h  00020192h CiA 402, drives and motion control  Live device
   6  -      00ABCDEFh  00001001h  00010002h  00000101h  00020192h CiA 402, drives and motion control  Live device
""")

    def test_it_waits_for_a_heartbeat_that_it_knows_of(self) -> None:
        self.edsc("write", 6, "1017h", 300, "--type", "u16")
        self.edsc("nmt", "start", 6)
        found = self.expect_json(self.edsc("scan", *self.some, *self.fast, "--format", "json"), "scan.schema.json")
        self.assertEqual([(node["node_id"], node["state"]) for node in found["nodes"]], [(5, None), (6, "operational")])

    def test_it_names_the_data_sheet_that_fits(self) -> None:
        text = SHEET.read_text()
        (self.folder / "newer.eds").write_text(text.replace("0x00010002", "0x00010003"))
        (self.folder / "next.eds").write_text(text.replace("0x00010002", "0x00020000"))
        (self.folder / "other.eds").write_text(text.replace("0x00001001", "0x00001002"))
        sheets = [word for name in ("device", "newer", "next", "other") for word in ("--eds", f"{name}.eds")]
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets)
        self.assertTrue(result.stdout.splitlines()[1].endswith(
            "device.eds, newer.eds (other minor revision), next.eds (other major revision)"), result.stdout)
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds", "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["data_sheets"], [])

    def test_it_says_why_a_file_fits_no_node(self) -> None:
        text = SHEET.read_text()
        (self.folder / "other.eds").write_text(text.replace("0x00001001", "0x00001002"))
        (self.folder / "serial.dcf").write_text(
            text.replace("0x00020192", "0x00040191") + "\n[DeviceComissioning]\nNodeID=6\nLSS_SerialNumber=0x101\n")
        result = self.edsc("scan", *self.some, *self.fast, "--eds", "device.eds", "--eds", "other.eds", "--eds", "serial.dcf")
        self.assertEqual(result.stdout.splitlines()[3:], [
            "other.eds does not match any node; node 5 is the closest: product code is 00001001h, expected 00001002h",
            "serial.dcf does not match any node; node 6 is the closest: device type is 00020192h, expected 00040191h"])
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds")
        self.assertEqual(result.stdout.splitlines()[2:],
                         ["other.eds does not match any node; node 5: product code is 00001001h, expected 00001002h"])
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "other.eds", "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["misfits"],
                         [{"file": "other.eds", "differences": "product code is 00001001h, expected 00001002h"}])

    def test_an_eds_without_vendor_fits_by_its_other_numbers(self) -> None:
        text = re.sub(r"0x00ABCDEF", "0", SHEET.read_text())
        (self.folder / "no_vendor.eds").write_text(text)
        (self.folder / "other_type.eds").write_text(text.replace("0x00020192", "0x00040191"))
        sheets = ("--eds", "no_vendor.eds", "--eds", "other_type.eds")
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets)
        self.assertTrue(result.stdout.splitlines()[1].endswith("no_vendor.eds (vendor-ID not compared)"), result.stdout)
        result = self.edsc("scan", "--nodes", "5", *self.fast, *sheets, "--format", "json")
        self.assertEqual(self.expect_json(result, "scan.schema.json")["nodes"][0]["data_sheets"],
                         [{"file": "no_vendor.eds", "fit": "same device", "not_compared": ["vendor_id"]}])

    def test_it_says_that_a_file_has_errors(self) -> None:
        (self.folder / "broken.eds").write_text(SHEET.read_text().replace("DefaultValue=1000", "DefaultValue=fast"))
        result = self.edsc("scan", "--nodes", "5", *self.fast, "--eds", "broken.eds")
        self.assertEqual(result.stderr, 'edsc: broken.eds: 1 error; invalid objects are skipped ("edsc check --keep-going" '
                         "lists them)\n")
        self.assertEqual(result.returncode, FINE)

    def test_it_asks_only_the_nodes_that_it_is_told(self) -> None:
        self.assertEqual(self.edsc("scan", "--nodes", "6..9", *self.fast).stdout.count("Live device"), 1)
        self.assertNotIn("605", [frame.split()[0] for frame in self.network.frames()])

    def test_a_stopped_node_is_known_by_its_heartbeat(self) -> None:
        self.edsc("write", 5, "1017h", 50, "--type", "u16")
        self.edsc("nmt", "stop", 5)
        result = self.edsc("scan", "--nodes", "5", *self.fast)
        self.assertEqual(result.stdout.splitlines()[1].split(), ["5", "stopped", *"-----"[:4], *"no answer over SDO".split(), "-"])


class ScanOfAnEmptyBus(LiveTest):
    nodes = ()

    def test_a_node_that_boots_is_asked_again(self) -> None:
        """It is not ready for the first request, and sends its boot-up message only then."""
        requests = []

        def answer(frame: str) -> list[str]:
            if not frame.startswith("607 40"):
                return []
            requests.append(frame)
            if len(requests) == 1:
                return ["707 00"]
            return ["587 43 00 10 00 92 01 02 00"] if frame[7:15] == "00 10 00" else [f"587 80 {frame[7:15]} 00 00 02 06"]

        self.network.device(answer)
        result = self.edsc("scan", "--nodes", "7", "--timeout", "500ms", "--for", "100ms", "--format", "json")
        (node,) = self.expect_json(result, "scan.schema.json")["nodes"]
        self.assertEqual((node["node_id"], node["answers_sdo"], node["device_type"]), (7, True, 0x20192))
        self.assertEqual([frame[7:15] for frame in requests[:2]], ["00 10 00", "00 10 00"])

    def test_nothing_is_there(self) -> None:
        self.expect(self.edsc("scan", "--timeout", "20ms", "--for", "20ms"), FAILED,
                    stderr=f"edsc: no node answers on {self.network.address}\n")

    def test_a_bus_that_is_not_there(self) -> None:
        self.network.close()
        result = self.edsc("scan")
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""))
        self.assertIn("Connection refused", result.stderr)

    def test_what_is_no_address(self) -> None:
        result = subprocess.run([EDSC, "scan", "can0"], capture_output=True, text=True, timeout=600)
        self.assertEqual(result.returncode, WRONG_USAGE)
        self.assertTrue(result.stderr.startswith('edsc: "can0" is not a bus address'), result.stderr)


if __name__ == "__main__":
    run()
