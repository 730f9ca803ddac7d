#!/usr/bin/env python3
"""edsc network scan, verify and apply with live nodes on the virtual bus of `edsc bus`.

    network_commands_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]
"""

from __future__ import annotations

import json
import re
import signal
import subprocess
import time
from pathlib import Path

from live import EDSC, FAILED, FINE, INTERRUPTED, PATIENCE_MS, SHEET, WRONG_USAGE, LiveTest, run


class NetworkCommands(LiveTest):
    nodes = (5, 6)

    def plant(self, nodes: dict, **members: object) -> Path:
        path = self.folder / "plant.json"
        path.write_text(json.dumps({"bit_rate": 500, "nodes": nodes, **members}, indent=2) + "\n")
        return path

    def two_axes(self, **settings: object) -> Path:
        """`axis1` with these values, `axis2` without."""
        return self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, "eds": "device.eds", "set": settings},
                           "axis2": {"node_id": 6, "serial_number": 0x101, "eds": "device.eds", "set": {"2004h": 1100}}})

    def network_command(self, action: str, *arguments: object,
                        timeout: int = PATIENCE_MS) -> subprocess.CompletedProcess[str]:
        return subprocess.run([str(EDSC), "network", action, self.network.address, *map(str, arguments), "--timeout",
                               f"{timeout}ms"], cwd=self.folder, capture_output=True, text=True, timeout=600)

    def place(self, file: str, text: str, column_of: str = "") -> str:
        """`FILE:LINE:COLUMN: error: ` of the first line with a text."""
        for number, line in enumerate((self.folder / file).read_text().splitlines(), 1):
            if text in line:
                return f"{file}:{number}:{line.index(column_of or text) + 1}: error: "
        raise AssertionError(f"{file} does not have {text}")

    def expect_nothing_started(self) -> None:
        self.assertFalse([frame for frame in self.network.frames("000") if frame.startswith("000 01")])

    def expect_nothing_written(self) -> None:
        frames = self.network.frames("000", "605", "606", "607")
        self.assertFalse([frame for frame in frames if frame.startswith("000 01") or frame[4] == "2"])

    def fake_axis(self, *after_download: str, at_first: tuple[str, ...] = (), after_upload: tuple[str, ...] = (),
                  ends_at: str | None = None, silent: tuple[str, ...] = (), refused: dict[str, str] | None = None) -> None:
        """Adds a node 7 with the identity of the EDS, which sends these frames before its first response and after each. It does not
        answer requests that begin with one of `silent`, nor after a frame that begins with `ends_at`, and aborts those that begin
        with one of `refused`."""
        has_power = True
        first = list(at_first)
        values = {"00 10 00": "92 01 02 00", "18 10 01": "EF CD AB 00", "18 10 02": "01 10 00 00",
                  "18 10 03": "02 00 01 00", "04 20 00": "E8 03", "05 20 00": "B8 0B", "00 18 01": "87 01 00 00",
                  "00 18 02": "FF", "00 18 03": "00 00", "00 18 05": "00 00", "00 1A 00": "02", "00 1A 01": "10 00 41 60",
                  "00 1A 02": "20 00 64 60", "20 10 01": "00 00 00 00", "20 10 02": "00 00 00 00", "10 10 01": "01 00 00 00"}

        def answer(frame: str) -> list[str]:
            nonlocal has_power
            has_power = has_power and not (ends_at and frame.startswith(ends_at))
            command, entry = frame[4:6], frame[7:15]
            if frame[:3] != "607" or command == "80" or frame.startswith(silent) or not has_power:
                return []
            for request, code in (refused or {}).items():
                if frame.startswith(request):
                    return [f"587 80 {entry} {code}"]
            if entry not in values:
                return [f"587 80 {entry} 00 00 02 06"]
            size = len(values[entry].split())
            if command == "40":
                response = f"587 {0x43 | 4 * (4 - size):02X} {entry} {values[entry]}" + " 00" * (4 - size)
                before = first.copy()
                first.clear()
                return [*before, response, *after_upload]
            values[entry] = frame[16:15 + 3 * size]
            return [f"587 60 {entry} 00 00 00 00", *after_download]

        self.network.device(answer)

    def three_axes(self, **settings: int) -> Path:
        eds = {"eds": "device.eds"}
        settings = settings or {"2004h": 1300, "2005h": 2900}
        return self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, **eds, "set": {"2004h": 1200}},
                           "axis3": {"node_id": 7, "serial_number": 0, **eds, "set": settings},
                           "axis2": {"node_id": 6, "serial_number": 0x101, **eds, "set": {"2004h": 1100}}})

    def test_a_good_plant(self) -> None:
        self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, "eds": "device.eds", "heartbeat_ms": 250},
                    "axis2": {"node_id": 6, "serial_number": 0x101, "eds": "device.eds", "set": {"2004h": 1200}}})
        self.expect(self.network_command("verify", "plant.json"), FAILED, """\
node axis1 (5): 1017h:00 Producer heartbeat time is 0 ms, expected 250 ms
node axis1 (5): 1 of 1 value differs
node axis2 (6): 2004h:00 Speed is 1000 rpm, expected 1200 rpm
node axis2 (6): 1 of 1 value differs
0 of 2 nodes as in plant.json
""")
        self.expect(self.network_command("apply", "plant.json", "--store", "--start"), FINE, """\
node axis1 (5): 1017h:00 Producer heartbeat time: 0 ms -> 250 ms
node axis2 (6): 2004h:00 Speed: 1000 rpm -> 1200 rpm
axis1: node 5: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written
axis2: node 6: 1 of 1 value differs; 1 of 1 value written, 1 verified, 1020h written
2 of 2 nodes configured, stored, started
""")
        self.expect(self.network_command("verify", "plant.json"), FINE, """\
node axis1 (5): 0 of 1 value differ
node axis2 (6): 0 of 1 value differ
2 of 2 nodes as in plant.json
""")
        frames = self.network.frames("000", "605", "606")
        written = [frame for frame in frames if frame[:3] == "000" or (frame[4] == "2" and frame[7:12] != "20 10")]
        self.assertEqual(written, ["000 80 05", "000 80 06", "605 2B 17 10 00 FA 00 00 00", "606 2B 04 20 00 B0 04 00 00",
                                   "605 23 10 10 01 73 61 76 65", "606 23 10 10 01 73 61 76 65",
                                   "000 01 05", "000 01 06"])

    def test_a_missing_node(self) -> None:
        self.three_axes()
        result = self.network_command("apply", "plant.json", "--start", timeout=1000)
        self.expect(result, FAILED, stderr=self.place("plant.json", '"axis3"') + "node axis3 (7) does not answer\nedsc: nothing written\n")
        result = self.network_command("verify", "plant.json", "--format", "json", timeout=1000)
        found = self.expect_json(result, "network_verify.schema.json", FAILED)
        self.assertEqual([(node["name"], node["answers"], node["same"]) for node in found["nodes"]],
                         [("axis1", True, False), ("axis3", False, False), ("axis2", True, False)])
        self.assertEqual([(one["index"], one["wanted"], one["found"]) for one in found["nodes"][0]["differences"]],
                         [("2004h:00", "1200 rpm", "1000 rpm")])
        self.expect_nothing_written()

    def test_another_product(self) -> None:
        (self.folder / "device.eds").write_text(SHEET.read_text())
        (self.folder / "other.eds").write_text(SHEET.read_text().replace("0x00001001", "0x00001002"))
        self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, "eds": "device.eds", "set": {"2004h": 1200}},
                    "axis2": {"node_id": 6, "serial_number": 0x101, "eds": "other.eds"}})
        product_code = self.place("other.eds", "DefaultValue=0x00001002", "0x")
        difference = f"{product_code}node axis2 (6) is not the device of other.eds: product code is 00001001h, expected 00001002h\n"
        self.expect(self.network_command("apply", "plant.json", "--start"), FAILED,
                    stderr=f"{difference}edsc: nothing written\n")
        result = self.network_command("verify", "plant.json")
        self.assertIn(difference, result.stdout)
        self.assertEqual(result.returncode, FAILED)
        self.expect_nothing_written()

    def test_another_minor_revision(self) -> None:
        """The node is the device of the file, but the generated master does not boot it."""
        (self.folder / "device.eds").write_text(SHEET.read_text().replace("0x00010002", "0x00010001"))
        self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, "eds": "device.eds", "set": {"2004h": 1000}}})
        result = self.network_command("verify", "plant.json")
        self.assertEqual((result.stderr, result.returncode),
                         ("edsc: node axis1 (5): revision number is 00010002h, expected 00010001h: another minor revision, which a "
                          "master rejects (1F87h)\n", FINE))

    def test_no_node_is_left(self) -> None:
        self.two_axes()
        self.expect(self.network_command("apply", "plant.json", "--skip", "axis1", "--skip", "axis2", "--start"), WRONG_USAGE,
                    stderr="edsc: plant.json: no node with an EDS or DCF is left\n")

    def test_another_mapping(self) -> None:
        """The network links a TPDO with the mapping of the EDS; the node has stored another one."""
        self.plant({"axis1": {"node_id": 5, "serial_number": 0x100, "eds": "device.eds"},
                    "axis2": {"node_id": 6, "serial_number": 0x101, "eds": "device.eds"},
                    "master": {"node_id": 127, "master": True}},
                   signals=[{"from": "axis1", "object": "6041h", "to": ["master"], "event": True},
                            {"from": "axis1", "object": "6064h", "to": ["master"], "event": True}])
        self.edsc("write", 5, "1800h:01", 0x80000185, "--type", "u32")
        self.edsc("write", 5, "1A00h:00", 0, "--type", "u8")
        self.edsc("write", 5, "1A00h:01", 0x60640020, "--type", "u32")
        self.edsc("write", 5, "1A00h:02", 0x60410010, "--type", "u32")
        self.edsc("write", 5, "1A00h:00", 2, "--type", "u8")
        self.edsc("write", 5, "1800h:01", 0x185, "--type", "u32")
        result = self.network_command("verify", "plant.json")
        self.assertIn("node axis1 (5): 1A00h:01 TPDO mapping parameter 1, Mapping entry 1 is 60640020h, "
                      "expected 60410010h\n", result.stdout)
        self.assertEqual(result.returncode, FAILED)
        self.assertEqual(self.network_command("apply", "plant.json").returncode, FINE)
        self.assertEqual(self.network_command("verify", "plant.json").returncode, FINE)

    def test_a_refused_value(self) -> None:
        self.two_axes(**{"2004h": 4000})
        result = self.network_command("apply", "plant.json", "--start", "--store")
        self.assertEqual(result.returncode, FAILED)
        self.assertIn(self.place("plant.json", '"2004h": 4000', "4000") + "node axis1 (5): 2004h:00 Speed = 4000 rpm: refused by "
                      "the device: 0609 0031h, value too high", result.stderr)
        self.assertTrue(result.stdout.endswith("0 of 2 nodes configured; none started\n"), result.stdout)
        self.expect(self.edsc("read", 6, "2004h", "--type", "u16"), FINE, "2004h:00 = 1000 (03E8h)\n")
        result = self.network_command("apply", "plant.json", "--start", "--on-error", "continue", "--format", "json")
        found = self.expect_json(result, "network_apply.schema.json", FAILED)
        self.assertEqual([(node["name"], node["succeeded"], node["attempts"]) for node in found["nodes"]],
                         [("axis1", False, 1), ("axis2", True, 1)])
        result = self.network_command("apply", "plant.json", "--on-error", "retry", "--retries", 2, "--format", "json")
        self.assertEqual([node["attempts"] for node in self.expect_json(result, "network_apply.schema.json", FAILED)["nodes"]],
                         [3, 0])
        self.expect_nothing_started()

    def test_an_identity_without_an_answer(self) -> None:
        """The number that would show another product does not arrive in time, or none does."""
        self.three_axes()
        self.fake_axis(silent=("607 40 18 10 02",))
        self.expect(self.network_command("apply", "plant.json", "--start", timeout=1000), FAILED,
                    stderr=self.place("plant.json", '"axis3"') +
                    "node axis3 (7) cannot be identified: 1018h:02 product code: no answer\nedsc: nothing written\n")
        self.expect_nothing_written()

    def test_a_node_without_an_identity(self) -> None:
        self.three_axes()
        self.fake_axis(refused={"607 40 00 10": "00 00 02 06", "607 40 18 10": "00 00 02 06"})
        result = self.network_command("apply", "plant.json", "--start")
        self.assertEqual(result.returncode, FAILED)
        self.assertIn(self.place("plant.json", '"axis3"') + "node axis3 (7) cannot be identified: it reports none of the "
                      "numbers that device.eds states\n", result.stderr)
        self.expect_nothing_written()

    def test_a_node_that_loses_power_after_it_was_configured(self) -> None:
        self.three_axes()
        self.fake_axis(ends_at="606 2B 04 20 00")
        result = self.network_command("apply", "plant.json", "--start", timeout=2000)
        self.assertEqual(result.returncode, FAILED)
        self.assertEqual(result.stderr, self.place("plant.json", '"axis3"') +
                         "node axis3 (7) no longer answers at 2004h:00 Speed\n")
        self.assertTrue(result.stdout.endswith("2 of 3 nodes configured; none started\n"), result.stdout)
        self.expect_nothing_started()

    def test_a_node_that_does_not_answer_while_its_values_are_read(self) -> None:
        self.three_axes()
        self.fake_axis(silent=("607 40 05 20 00",))
        result = self.network_command("apply", "plant.json", timeout=1000)
        self.assertIn(self.place("plant.json", '"axis3"') + "node axis3 (7) no longer answers at 2005h:00 Maximum speed\n",
                      result.stderr)
        self.expect_nothing_written()

    def test_an_interruption(self) -> None:
        self.three_axes()
        self.fake_axis(silent=("607 2B",))
        process = subprocess.Popen([EDSC, "network", "apply", self.network.address, "plant.json", "--start", "--timeout",
                                    f"{PATIENCE_MS}ms"], cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(process.kill)
        while not any(frame.startswith("607 2B") for frame in self.network.log):
            time.sleep(0.02)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=600)
        self.assertEqual((process.returncode, err), (INTERRUPTED, self.place("plant.json", '"axis3"') +
                         "node axis3 (7) is not completely configured\nedsc: interrupted\n"))
        self.assertTrue(out.endswith("1 of 3 nodes configured; none started\n"), out)
        self.expect_nothing_started()

    def test_a_mapping_that_cannot_be_cleared(self) -> None:
        """The step has no value; its line is that of the number of mapped objects."""
        self.three_axes(**{"1A00h:01": 0x60640020, "1A00h:00": 1})
        self.fake_axis(refused={"607 2F 00 1A 00": "42 00 04 06"})
        result = self.network_command("apply", "plant.json")
        self.assertEqual(result.returncode, FAILED)
        line = self.place("plant.json", '"1A00h:00": 1').rsplit(":", 3)[0]
        self.assertRegex(result.stderr, rf"{line}:\d+: error: node axis3 \(7\): 1A00h:00 TPDO mapping parameter 1, Number of mapped "
                         "objects: refused by the device: 0604 0042h")

    def test_parameters_that_cannot_be_stored(self) -> None:
        self.three_axes()
        self.fake_axis(refused={"607 23 10 10 01": "00 00 06 06"})
        result = self.network_command("apply", "plant.json", "--store")
        self.assertEqual(result.returncode, FAILED)
        self.assertEqual(result.stderr, self.place("plant.json", '"axis3"') + "node axis3 (7): 1010h:01 Store parameters: refused "
                         "by the device: 0606 0000h, access failed, hardware error\n")

    def test_two_nodes_with_one_node_id(self) -> None:
        self.three_axes()
        self.fake_axis(after_upload=("587 43 18 10 04 01 00 00 00",))
        self.expect(self.network_command("apply", "plant.json", "--start"), FAILED,
                    stderr=self.place("plant.json", '"axis3"') +
                    "node axis3 (7): an SDO request got more than one response; two nodes may have node-ID 7\n"
                           "edsc: nothing written\n")
        self.expect_nothing_written()

    def test_a_response_to_a_request_that_was_not_seen(self) -> None:
        """Another client sent the request. The response to it arrives before the command asks node 6, since node 7, which sends it
        before its own response, is asked first."""
        self.three_axes()
        self.fake_axis(at_first=("586 43 18 10 04 01 01 00 00",))
        result = self.network_command("apply", "plant.json")
        self.assertEqual((result.returncode, result.stderr), (FINE, ""))

    def test_a_node_that_restarts_in_the_middle(self) -> None:
        self.three_axes()
        self.fake_axis("707 00")
        result = self.network_command("apply", "plant.json", "--start", "--store")
        self.assertEqual(result.returncode, FAILED)
        # The boot-up message follows the response, so that it may be noticed in the next transfer.
        self.assertRegex(result.stderr, r"plant.json:\d+:5: error: node axis3 \(7\) restarted at 200[45]h:00 (Speed|Maximum speed) while it was "
                                        r"configured: it may have lost what was written\n")
        self.assertTrue(result.stdout.endswith("1 of 3 nodes configured; none started\n"), result.stdout)
        frames = self.network.frames("000", "605", "606", "607")
        self.assertFalse([frame for frame in frames if frame.startswith("000 01") or frame[4:15] == "23 10 10 01"])

    def test_another_master_that_starts_the_nodes(self) -> None:
        self.three_axes()
        self.fake_axis("000 01 00")
        result = self.network_command("apply", "plant.json", "--start")
        self.assertEqual(result.returncode, FAILED, result.stdout)
        for node in ("axis1 (5)", "axis3 (7)", "axis2 (6)"):
            self.assertRegex(result.stderr, rf"plant.json:\d+:5: error: node {re.escape(node)} received a command of another NMT "
                                            r"master while it was configured\n")
        self.assertTrue(result.stdout.endswith("0 of 3 nodes configured; none started\n"), result.stdout)
        self.assertFalse([frame for frame in self.network.frames("000") if frame[4:6] == "01" and frame != "000 01 00"])

    def test_scan_writes_the_network_file(self) -> None:
        sheets = self.folder / "sheets"
        sheets.mkdir()
        (sheets / "drive.eds").write_text(SHEET.read_text())
        (sheets / "newer.eds").write_text(SHEET.read_text().replace("0x00010002", "0x00010003"))
        self.edsc("write", 6, "1017h", 300, "--type", "u16")
        some = ("--eds", "sheets", "--nodes", "5,6,7", "--for", "100ms", "-o", "plant.json")
        result = self.network_command("scan", *some, "--bit-rate", "500", timeout=5000)
        self.assertEqual((result.stdout, result.returncode), ("plant.json: 2 of 2 nodes\n", FINE), result.stderr)
        self.assertIn("edsc: node 5: sheets/newer.eds fits too; using sheets/drive.eds\n", result.stderr)
        text = (self.folder / "plant.json").read_text()
        found = json.loads("\n".join(line for line in text.splitlines() if not line.strip().startswith("//")))
        self.assertEqual(found, {"bit_rate": 500, "nodes": {
            "drive_5": {"node_id": 5, "eds": "sheets/drive.eds", "serial_number": 0x100},
            "drive_6": {"node_id": 6, "eds": "sheets/drive.eds", "heartbeat_ms": 300, "serial_number": 0x101}}})
        check = subprocess.run([EDSC, "network", "check", "plant.json"], cwd=self.folder, capture_output=True, text=True,
                               timeout=600)
        self.assertEqual(check.returncode, FINE, check.stdout + check.stderr)
        self.assertEqual(self.network_command("verify", "plant.json").returncode, FINE)

    def test_scan_with_files_in_place_of_their_folder(self) -> None:
        for name in ("drive", "unused"):
            (self.folder / f"{name}.eds").write_text(SHEET.read_text())
        result = self.network_command("scan", "--eds", "drive.eds", "--nodes", "5", "--for", "100ms", timeout=5000)
        self.assertEqual(result.returncode, FINE, result.stderr)
        self.assertIn('"eds": "drive.eds"', result.stdout)

    def test_scan_of_a_folder_with_generated_files(self) -> None:
        """The DCFs of `edsc network generate` fit as well; they are not the files of the vendor."""
        (self.folder / "plant.json").write_text(json.dumps({"bit_rate": 500, "nodes": {
            "plc": {"node_id": 127, "master": True}, "axis": {"node_id": 5, "eds": "device.eds", "heartbeat_ms": 300}}}))
        for output in ("build", "."):
            made = subprocess.run([EDSC, "network", "generate", "plant.json", "-o", output], cwd=self.folder, capture_output=True,
                                  text=True, timeout=600)
            self.assertEqual(made.returncode, FINE, made.stderr)
        self.assertTrue((self.folder / "axis.dcf").exists())
        result = self.network_command("scan", "--eds", ".", "--nodes", "5", "--for", "100ms", timeout=5000)
        self.assertEqual(result.returncode, FINE, result.stderr)
        self.assertIn('"eds": "device.eds"', result.stdout)
        self.assertNotIn("fits too", result.stderr)

    def test_scan_of_two_nodes_with_one_node_id(self) -> None:
        self.network.device(lambda frame: ["585 43 00 10 00 92 01 02 00"] if frame.startswith("605 40 00 10 00") else [])
        result = self.network_command("scan", "--eds", ".", "--nodes", "5,6", "--for", "500ms", timeout=5000)
        self.assertEqual(result.returncode, FAILED, result.stderr)
        twice = "node 5: an SDO request got more than one response; two nodes may have node-ID 5\n"
        self.assertIn("edsc: " + twice, result.stderr)
        self.assertNotIn("node-ID 6", result.stderr)
        self.assertIn(twice, self.edsc("scan", "--nodes", "5,6", "--for", "500ms").stdout)

    def test_scan_of_a_node_without_a_file(self) -> None:
        sheets = self.folder / "sheets"
        sheets.mkdir()
        (sheets / "other.eds").write_text(SHEET.read_text().replace("0x00001001", "0x00001002"))
        result = self.network_command("scan", "--eds", "sheets", "--nodes", "5", "--for", "100ms", timeout=5000)
        self.assertEqual(result.returncode, FAILED)
        self.assertIn("edsc: node 5: no file fits; the closest is sheets/other.eds: product code is 00001001h, "
                      "expected 00001002h\n", result.stderr)
        self.assertIn('// "node_5": {"node_id": 5, "eds": ""}', result.stdout)


if __name__ == "__main__":
    run()
