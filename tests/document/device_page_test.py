#!/usr/bin/env python3
"""The pages of edsc document in headless Chromium: axe-core finds no violation, search, filters and links are used as a
user does, tidy reads the HTML, and the drawings are compared with mappings worked out by hand.

    device_page_test.py SOURCE_DIR EDSC WORK_DIR [--sample] [unittest arguments]

npm installs puppeteer-core and axe-core in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import configparser
import shutil
import subprocess
from pathlib import Path

from document_case import DEVICES, SOURCE_DIR, DocumentCase, main, sampled, sheet, var

EVIL = '</script><img src=x onerror=alert(1)>"\'&<!--{{name}}\u202e'
BIT = 12  # units of the drawing


def indices(path: Path) -> list[str]:
    """The objects of an EDS, read by configparser."""
    file = configparser.RawConfigParser(strict=False, comment_prefixes=(";",), delimiters=("=",))
    file.read_string(path.read_text(encoding="utf-8"))
    return sorted(f"{section.upper()}h" for section in file.sections() if len(section) == 4)


class DevicePage(DocumentCase):
    def test_the_pages_of_all_devices_are_clean_in_light_and_dark(self) -> None:
        self.assertEqual(len(DEVICES), 8)
        self.assert_clean(self.browse("audit", *(self.document(path) for path in sampled(DEVICES))))

    def test_a_page_with_everything_expanded_is_clean(self) -> None:
        new = SOURCE_DIR / "eds/cpd.eds"
        old = self.write("old.eds", new.read_text().replace("ParameterName=Statusword", "ParameterName=Status")
                         .replace("BaudRate_125=1", "BaudRate_125=0"))
        page = self.document(new, "--against", old)
        self.assert_clean(self.browse("audit-expanded", page))

    def test_tidy_reads_the_html_without_errors(self) -> None:
        if shutil.which("tidy") is None:
            self.skipTest("tidy is not installed")
        for path in DEVICES:
            tidy = subprocess.run(["tidy", "-q", "-e", "--drop-empty-elements", "no", self.document(path)],
                                  capture_output=True, text=True)
            self.assertEqual((tidy.stderr, tidy.returncode), ("", 0), path.name)

    def test_search_filters_links_and_keys(self) -> None:
        path = SOURCE_DIR / "eds/ezd-1136.eds"
        found = self.browse("use", self.document(path))
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        everything = indices(path)
        self.assertEqual(found["all"], {"objects": everything, "status": f"{len(everything)} objects"})
        self.assertEqual(found["focused"], "query")
        for text in ("6041h", "6041", "0x6041", "od::statusword"):
            self.assertEqual(found[text]["objects"][-1:], ["6041h"], text)
        self.assertEqual(found["1018h:04"]["objects"], ["1018h"])
        self.assertEqual(found["hits"], ["1018h-04"])
        self.assertIn("607Ah", found["target position"]["objects"])
        self.assertLess(len(found["access"]["objects"]), len(everything), "the heads of the tables are not searched")
        self.assertEqual(found["no such object"], {"objects": [], "status": f"0 of {len(everything)} objects"})
        self.assertEqual(found["escaped"]["objects"], everything)
        self.assertEqual(found["area 6000"]["objects"], [one for one in everything if "6000h" <= one < "A000h"])
        self.assertEqual(found["reset"]["objects"], everything)
        self.assertEqual(found["link"], {"isVisible": True, "target": "1018h-02"})
        self.assertTrue(found["copied"].startswith("od::"))
        self.assertTrue(found["opensByKey"] and found["expanded"])
        self.assertEqual(found["printed"], {"isOpen": True, "tools": False})
        self.assertFalse(found["after"])

    def test_a_narrow_screen(self) -> None:
        for name in ("ezd-1136", "rk5c"):
            found = self.browse("narrow", self.document(SOURCE_DIR / f"eds/{name}.eds"))
            self.assertEqual(found, {"page": 0, "cut": [], "cards": []}, name)

    def test_filters_select_by_the_keys_of_the_eds(self) -> None:
        path = self.write("drive.eds", sheet(
            var(0x2000, "Plain"), var(0x2001, "Command", AccessType="wo", PDOMapping="1"),
            var(0x2002, "Actual value", AccessType="ro", PDOMapping="1"), var(0x2003, "Small", DataType="2"),
            var(0x6041, "Status", AccessType="ro", PDOMapping="1"),
            var(0x1018, "Identity").replace("ObjectType=7", "ObjectType=9\nSubNumber=5").replace("DataType=6\n", ""),
            *(var(0x1018, f"Number {sub}", DataType="7" if sub else "5", AccessType="ro", DefaultValue="7" if sub else "4")
              .replace("[1018]", f"[1018sub{sub}]") for sub in range(5))))
        found = self.browse("use", self.document(path, "--keep-going"))
        self.assertEqual(found["access wo"]["objects"], ["2001h"])
        self.assertEqual(found["type INTEGER8"]["objects"], ["2003h"])
        self.assertEqual(found["pdo rpdo"]["objects"], ["2001h"])
        self.assertEqual(found["pdo tpdo"]["objects"], ["2002h", "6041h"])
        self.assertEqual(found["pdo mapped"]["objects"], [])
        self.assertEqual(found["area 6000"]["objects"], ["6041h"])

    def test_a_drawing_has_the_bits_of_the_mapping(self) -> None:
        found = self.browse("drawings", self.document(SOURCE_DIR / "eds/ezd-1136.eds"))
        # 1600h: 60400010h, 60600008h, 60980008h, 607C0020h
        self.assertEqual(found["rpdo-1"]["fields"], [
            [1, 16 * BIT, "6040h:00 Controlword, bits 0..15"],
            [1 + 16 * BIT, 8 * BIT, "6060h:00 Modes of operation, bits 16..23"],
            [1 + 24 * BIT, 8 * BIT, "6098h:00 Homing method, bits 24..31"],
            [1 + 32 * BIT, 32 * BIT, "607Ch:00 Home offset, bits 32..63"]])
        self.assertEqual(found["rpdo-1"]["label"], "RPDO 1, 64 bits. bits 0..15: Controlword; bits 16..23: Modes of "
                         "operation; bits 24..31: Homing method; bits 32..63: Home offset")
        self.assertIsNone(found["tpdo-4"]["label"])

    def test_a_field_has_the_name_of_its_entry_if_that_of_its_object_does_not_fit(self) -> None:
        found = self.browse("texts", self.document(SOURCE_DIR / "eds/rk5c.eds"), "#tpdo-1 svg g text:first-of-type")
        # 6020h:01 and 6030h:01; with that of its object, neither fits 32 and 16 bits.
        self.assertEqual(found["#tpdo-1 svg g text:first-of-type"], ["Position value channel 1", "Speed value channel 1"])

    def test_times_of_a_pdo_are_in_milliseconds(self) -> None:
        parameters = {1: ("7", "$NODEID+0x40000180"), 2: ("5", "254"), 3: ("6", "15"), 5: ("6", "250")}
        path = self.write("timers.eds", sheet(
            var(0x2000, "Speed", PDOMapping="1"),
            *(var(index, "TPDO").replace("ObjectType=7", "ObjectType=9").replace("DataType=6\n", "")
              for index in (0x1800, 0x1A00)),
            var(0x1800, "Highest", DataType="5", AccessType="const", DefaultValue="5").replace("[1800]", "[1800sub0]"),
            *(var(0x1800, f"Parameter {sub}", DataType=kind, DefaultValue=value).replace("[1800]", f"[1800sub{sub}]")
              for sub, (kind, value) in parameters.items()),
            var(0x1A00, "Number", DataType="5", DefaultValue="1").replace("[1A00]", "[1A00sub0]"),
            var(0x1A00, "First", DataType="7", DefaultValue="0x20000010").replace("[1A00]", "[1A00sub1]")))
        found = self.browse("drawings", self.document(path, "--keep-going"))["tpdo-1"]["properties"]
        self.assertEqual({key: found[key] for key in ("CAN-ID", "Transmission type", "Inhibit time", "Event timer")},
                         {"CAN-ID": "180h + node-ID", "Transmission type": "254, event-driven (manufacturer)",
                          "Inhibit time": "1.5 ms", "Event timer": "250 ms"})
        self.write("timers.options.json", '{"pdo": {"inhibit_time_unit": 1000}}')
        found = self.browse("drawings", self.document(path, "--keep-going"))["tpdo-1"]["properties"]
        self.assertEqual(found["Inhibit time"], "15 ms")

    def test_texts_of_the_eds_are_not_markup(self) -> None:
        path = self.write("evil.eds", sheet(
            "; a comment with </script>\n" +
            var(0x2000, EVIL, Description=EVIL, Unit=EVIL, DataType="9", DefaultValue=EVIL),
            vendor=EVIL, product=EVIL))
        page = self.document(path, "--keep-going")
        self.assertNotIn("\u202e", page.read_text())
        found = self.browse("texts", page, "h1", "img", "script", "#objects summary .name", "#objects .body > p:nth-child(2)")
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        shown = EVIL.replace("\u202e", "<U+202E>")
        self.assertEqual((found["h1"], found["#objects summary .name"]), ([shown], [shown]))
        self.assertEqual((found["img"], len(found["script"])), ([], 1))
        self.assertEqual(found["#objects .body > p:nth-child(2)"], ["a comment with </script>"])
        self.assert_clean(self.browse("audit-expanded", page))

    def test_ten_thousand_objects(self) -> None:
        objects = (var(0x2000 + i, f"Speed parameter {i}", DefaultValue=str(i), Description=f"Text of parameter {i}")
                   for i in range(10_000))
        page = self.document(self.write("large.eds", sheet(*objects)), "--keep-going")
        found = self.browse("speed", page)
        times = {text: round(time, 1) for text, (time, _) in found["times"].items()}
        print(f"\n10,000 objects, {page.stat().st_size:,} bytes: load {found['loaded']} ms, "
              f"processor time of a search in ms {times}")
        counts = {text: status for text, (_, status) in found["times"].items()}
        self.assertEqual(counts["3456h"], "1 of 10000 objects")
        self.assertEqual(counts["nothing"], "0 of 10000 objects")
        self.assertEqual(counts[""], "10000 objects")
        self.assertLess(max(times.values()), 400)  # usually less than 50 ms; here for a slow machine


if __name__ == "__main__":
    main()
