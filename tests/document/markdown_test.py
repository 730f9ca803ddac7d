#!/usr/bin/env python3
"""The Markdown of edsc document, read by npm's marked: the tables have the columns of the EDS, which configparser reads.

    markdown_test.py SOURCE_DIR EDSC WORK_DIR [unittest arguments]

npm installs marked in WORK_DIR. Exit code 77: skipped.
"""

from __future__ import annotations

import configparser
import html
import re
from pathlib import Path

from document_case import DEVICES, SOURCE_DIR, DocumentCase, main, sheet, var
from data_sheet import TYPES  # noqa: E402, I001 (document_case adds its folder)

SECTION = re.compile(r"([0-9A-Fa-f]{4})(?:sub([0-9A-Fa-f]+))?")
EVIL = r"a|b `code` *c* _d_ [e](f) <script>alert(1)</script> \| ~g~"


def entries_of(path: Path) -> dict[tuple[str, str], tuple[str, str, str]]:
    """Name, type and access of each entry with a DataType."""
    file = configparser.RawConfigParser(strict=False, comment_prefixes=(";",), delimiters=("=",))
    file.read_string(path.read_text(encoding="utf-8"))
    found = {}
    for section in file.sections():
        match, keys = SECTION.fullmatch(section), file[section]
        if match and "datatype" in keys:
            found[f"{match[1].upper()}h", f"{int(match[2] or '0', 16):02X}"] = (
                keys["ParameterName"], TYPES[int(keys["DataType"], 0)][0], keys["AccessType"])
    return found


def plain(cell: str) -> str:
    return html.unescape(re.sub("<[^>]*>", "", cell))


OBJECT_COLUMNS = ["Sub", "Name", "Type", "Access", "PDO", "Default", "Limits", "Unit", "C++ name", "Line"]


def without_comment(name: str, expected: str) -> str:
    """The name of an entry in its table, without the comment of the EDS that may follow."""
    return expected if name.startswith(expected + ": ") else name


class Markdown(DocumentCase):
    def tables(self, path: Path, *arguments: object) -> list[dict]:
        return self.node("tables.mjs", self.document(path, *arguments, output=path.stem + ".md"))

    def test_the_object_tables_have_the_keys_of_the_eds(self) -> None:
        for path in DEVICES:
            expected, found = entries_of(path), {}
            for table in self.tables(path):
                if table["header"] == OBJECT_COLUMNS:
                    index = plain(table["heading"])[:5]
                    for row in table["rows"]:
                        found[index, plain(row[0])] = tuple(map(plain, row[1:4]))
            rows = {key: (without_comment(found[key][0], value[0]), *found[key][1:])
                    for key, value in expected.items() if key in found}
            self.assertEqual(rows, expected, path.name)

    def test_the_rows_of_a_mapping(self) -> None:
        tables = [one for one in self.tables(SOURCE_DIR / "eds/ezd-1136.eds") if one["heading"] == "RPDO 1"]
        self.assertEqual(tables[1]["header"], ["Bits", "Entry", "Name", "Type"])
        self.assertEqual([list(map(plain, row)) for row in tables[1]["rows"]], [
            ["0..15", "6040h:00", "Controlword", "UNSIGNED16"], ["16..23", "6060h:00", "Modes of operation", "INTEGER8"],
            ["24..31", "6098h:00", "Homing method", "INTEGER8"], ["32..63", "607Ch:00", "Home offset", "INTEGER32"]])

    def test_texts_of_the_eds_are_not_markup(self) -> None:
        path = self.write("evil.eds", sheet(var(0x2000, EVIL, Unit=EVIL), vendor=EVIL, product=EVIL))
        table = self.tables(path, "--keep-going")[-1]
        self.assertEqual(len(table["rows"][0]), 10)
        self.assertEqual(html.unescape(table["rows"][0][1]), EVIL)
        self.assertEqual(html.unescape(table["rows"][0][7]), EVIL)
        self.assertEqual(table["rows"][0][8], "<code>" + plain(table["rows"][0][8]) + "</code>")

    def test_every_table_has_a_cell_for_each_column(self) -> None:
        for source in (SOURCE_DIR / "eds/cpd.eds", SOURCE_DIR / "examples/networks/twelve_axes.json"):
            text = self.document(source, "--format", "markdown", output="page").read_text()
            for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
                cells = {len(re.findall(r"(?<!\\)\|", line)) for line in block.splitlines()}
                self.assertEqual(len(cells), 1, block)


if __name__ == "__main__":
    main()
