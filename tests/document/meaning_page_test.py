#!/usr/bin/env python3
"""The meaning of values in the pages of edsc document, in headless Chromium and as Markdown: physical values, names of
values, drawn bits, states and error codes, each compared with an options file that the test writes.

    meaning_page_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

npm installs puppeteer-core, axe-core and marked in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

from document_case import DocumentCase, main, sheet, var

OBJECTS = (
    var(0x1003, "Error").replace("DataType=6", "DataType=7"),
    var(0x2000, "Temperature", DataType="3", DefaultValue="215", LowLimit="-400", HighLimit="1250"),
    var(0x2001, "Mode", DataType="2", DefaultValue="1"),
    var(0x2002, "Status", DefaultValue="0x0125"),
    var(0x2003, "Flags", DataType="7", DefaultValue="0x80000001"),
    var(0x2004, "Small", DataType="5", DefaultValue="0"),
    var(0x2005, "Same mode", DataType="2"),
)
MEANING = {
    "2000h": {"unit": "°C", "scale": "1/10", "offset": "-10", "text": "Of the oil.", "place": "3.1"},
    "2001h": {"values": {"-1": "homing", "0": "off", "1": {"name": "run", "text": "The motor turns", "place": "4.2"}},
              "closed": True},
    "2002h": {
        "place": "5.1, table 3",
        "bits": {"0": "ready", "1": None, "2": {"name": "moving", "place": "5.2"}, "4..7": "gear",
                 "8": {"name": "heat", "values": {"0": "cold", "1": {"name": "hot", "text": "above 60 °C"}}}},
        "masked": {"state": {"off": ["0x05", "0x00"], "moves": {"mask": "0x05", "value": "0x05", "text": "It moves"}}},
        "depends_on": "2001h",
        "cases": {"1": {"bits": {"12": "at_speed"}}, "-1, 0": {"name": "idle", "bits": {"12..13": "brake"}}},
    },
    "2003h": {"bits": {"0": "first", "14..17": "across_the_rows", "31": "last"}},
    "2004h": {"bits": {"0..3": {"name": "level", "unit": "%", "scale": "10"}}},
    "2005h": {"same_as": "2001h"},
    "emcy": {"2310h": {"text": "motor current", "place": "7, table 9"}, "FF01h": "door open"},
}


def plain(cell: str) -> str:
    return html.unescape(re.sub("<[^>]*>", "", cell.replace("<br>", "\n")))


class MeaningPage(DocumentCase):
    def page(self, name: str = "drive.html") -> Path:
        path = self.write("drive.eds", sheet(*OBJECTS))
        self.write("drive.options.json", json.dumps({"meaning": MEANING}))
        return self.document(path, "--keep-going", output=name)

    def tables(self, index: str) -> list:
        found = self.browse("meaning", self.page(), index)
        self.assertEqual(found["seen"], {"errors": [], "requests": []})
        return found["tables"]

    def test_a_quantity(self) -> None:
        (objects,) = self.tables("2000h")
        head, row = objects[1:]
        cells = dict(zip(head, row))
        # 215 / 10 - 10, -400 / 10 - 10 and 1250 / 10 - 10
        self.assertEqual((cells["Default"], cells["Limits"], cells["Unit"]),
                         ("215\n11.5 °C", "-400 .. 1250\n-50 °C..115 °C", "× 0.1 °C, 0 is -10 °C"))
        found = self.browse("texts", self.page(), '[id="2000h"] .meaning p', '[id="2000h"] summary .mono')
        self.assertEqual(found['[id="2000h"] .meaning p'], ["Of the oil.", "Source: 3.1"])
        self.assertEqual(found['[id="2000h"] summary .mono'], ["11.5 °C"])

    def test_names_of_values(self) -> None:
        objects, values = self.tables("2001h")
        self.assertIn("1\n1 run", objects[2])
        self.assertEqual(values, ["Values", ["Value", "Name", "Text", "Source"], ["-1", "homing", "", ""],
                                  ["0", "off", "", ""], ["1", "run", "The motor turns", "4.2"]])
        found = self.browse("texts", self.page(), '[id="2001h"] .meaning p', '[id="2005h"] .meaning td.mono')
        self.assertEqual(found['[id="2001h"] .meaning p'], ["Other values are rejected."])
        self.assertEqual(found['[id="2005h"] .meaning td.mono'], ["homing", "off", "run"])

    def test_bits_are_drawn_for_each_mode(self) -> None:
        objects, every_mode, fields, run, at_speed, idle, _, states = self.tables("2002h")
        self.assertIn("0x0125\n0125h moves, gear=2, heat=hot", objects[2])
        numbers = [str(bit) for bit in range(15, -1, -1)]
        common = [["", 3, "unused"], ["heat", 1, "field"], ["gear", 4, "field"], ["", 1, "unused"],
                  ["moving", 1, "field"], ["reserved", 1, "reserved"], ["ready", 1, "field"]]
        other = [[label, bits, "other" if kind == "field" else kind] for label, bits, kind in common]
        self.assertEqual(every_mode, ["Bits in each mode", numbers, [["", 2, "unused"], ["by mode", 2, "mode"], *common]])
        self.assertEqual(idle, ['2001h "Mode" = -1, 0, idle', numbers,
                                [["", 2, "unused"], ["brake", 2, "field"], *other]])
        self.assertEqual(run, ['2001h "Mode" = 1, run', numbers,
                               [["", 3, "unused"], ["at_speed", 1, "field"], *other]])
        self.assertEqual(fields, ["", ["Bits", "Field", "Text", "Source"], ["0", "ready", "", ""],
                                  ["1", "reserved", "", ""], ["2", "moving", "", "5.2"], ["4..7", "gear", "", ""],
                                  ["8", "heat", "0 cold\n1 hot above 60 °C", ""]])
        self.assertEqual(at_speed, ["", ["Bits", "Field"], ["12", "at_speed"]])
        self.assertEqual(states, ["state", ["Value", "Bits", "Mask", "Masked", "Text"],
                                  ["off", "xxxx xxxx xxxx x0x0", "0005h", "0000h", ""],
                                  ["moves", "xxxx xxxx xxxx x1x1", "0005h", "0005h", "It moves"]])

    def test_words_of_32_and_8_bits(self) -> None:
        _, word, _ = self.tables("2003h")
        self.assertEqual(word[1:], [
            [str(bit) for bit in range(31, 15, -1)],
            [["last", 1, "field"], ["", 13, "unused"], ["across_the_rows", 2, "field"]],
            [str(bit) for bit in range(15, -1, -1)],
            [["across_the_rows", 2, "field"], ["", 13, "unused"], ["first", 1, "field"]]])
        _, word, fields = self.tables("2004h")
        self.assertEqual(word[1:], [[str(bit) for bit in range(7, -1, -1)], [["", 4, "unused"], ["level", 4, "field"]]])
        self.assertEqual(fields[2], ["0..3", "level", "× 10 %"])

    def test_error_codes(self) -> None:
        device, profile = self.tables("error-codes")
        self.assertEqual(device, ["", ["Code", "Error", "Source"], ["2310h", "motor current", "7, table 9"],
                                  ["FF01h", "door open", ""]])
        self.assertIn(["1000h", "generic error"], profile)

    def test_a_meaning_of_several_objects_is_drawn_once(self) -> None:
        def rpdo(index: int) -> str:
            record = var(index, "RPDO").replace("ObjectType=7", "ObjectType=9").replace("DataType=6\n", "")
            entries = ((0, "5", "2"), (1, "7", "0x80000200"), (2, "5", "255"))
            return record + "".join(
                var(index, f"Parameter {sub}", DataType=kind, DefaultValue=value).replace(f"[{index:04X}]", f"[{index:04X}sub{sub}]")
                for sub, kind, value in entries)
        page = self.document(self.write("two.eds", sheet(rpdo(0x1400), rpdo(0x1401))), "--keep-going")
        found = self.browse("texts", page, '[id="1400h"] .meaning a', '[id="1401h"] .meaning a', '[id="1401h"] .bits')
        self.assertEqual(found['[id="1400h"] .meaning a'], [])
        self.assertEqual(found['[id="1401h"] .meaning a'][0], "1400h-01")
        self.assertEqual(found['[id="1401h"] .bits'], [])

    def test_the_page_is_clean_and_narrow(self) -> None:
        page = self.page()
        self.assert_clean(self.browse("audit-expanded", page))
        self.assertEqual(self.browse("narrow", page), {"page": 0, "cut": [], "cards": []})

    def test_markdown(self) -> None:
        tables = self.node("tables.mjs", self.page("drive.md"))
        of = [(plain(one["heading"]).split(" ")[0], one["header"], [list(map(plain, row)) for row in one["rows"]])
              for one in tables]
        rows = {index: row for index, header, (row, *_) in of if header[:2] == ["Sub", "Name"]}
        self.assertEqual(rows["2000h"][5:8], ["215: 11.5 °C", "-400 .. 1250: -50 °C..115 °C", "× 0.1 °C, 0 is -10 °C"])
        found = [rows for index, header, rows in of if index == "2002h" and header[0] in ("Bits", "Value")]
        self.assertEqual([row[:2] for row in found[0]],
                         [["0", "ready"], ["1", "reserved"], ["2", "moving"], ["4..7", "gear"], ["8", "heat"]])
        self.assertEqual([row[:2] for row in found[-1]], [["off", "xxxx xxxx xxxx x0x0"], ["moves", "xxxx xxxx xxxx x1x1"]])
        self.assertIn(["FF01h", "door open", ""], next(rows for _, header, rows in of if header[0] == "Code"))


if __name__ == "__main__":
    main()
