#!/usr/bin/env python3
"""The language server by a scripted client. Its diagnostics must be the findings of `edsc check` for the same text.

    lsp_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from collections import Counter
from pathlib import Path
from typing import Any

from lsp_client import Client, applied

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
CPC = SOURCE_DIR / "eds/cpc-tc1.eds"
SEVERITY = {"error": 1, "warning": 2, "note": 3}

SHEET = """[FileInfo]
FileName=small.eds
FileVersion=1
FileRevision=1
EDSVersion=4.0

[DeviceInfo]
VendorName=é𝄞
VendorNumber=1
ProductName=small
ProductNumber=2
RevisionNumber=3
BaudRate_125=1
Granularity=8
NrOfRXPDO=0
NrOfTXPDO=1
LSS_Supported=0

[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018

[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0

[1001]
ParameterName=Error register
ObjectType=0x7
DataType=0x0005
AccessType=ro

[1018]
ParameterName=Identity
ObjectType=0x9
SubNumber=4

[1018sub0]
ParameterName=Highest sub-index
ObjectType=0x7
DataType=0x0005
AccessType=const
DefaultValue=3

[1018sub1]
ParameterName=Vendor-ID
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=1

[1018sub2]
ParameterName=Product code
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=2

[1018sub3]
ParameterName=Revision number
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=3

[OptionalObjects]
SupportedObjects=3
1=0x1017
2=0x1800
3=0x1A00

[1017]
ParameterName=Producer heartbeat time
ObjectType=0x7
DataType=0x0006
AccessType=rw
DefaultValue=0

[1800]
ParameterName=TPDO 1
ObjectType=0x9
SubNumber=3

[1800sub0]
ParameterName=Highest sub-index
ObjectType=0x7
DataType=0x0005
AccessType=const
DefaultValue=2

[1800sub1]
ParameterName=COB-ID
ObjectType=0x7
DataType=0x0007
AccessType=rw
DefaultValue=$NODEID+0x180

[1800sub2]
ParameterName=Transmission type
ObjectType=0x7
DataType=0x0005
AccessType=rw
DefaultValue=255

[1A00]
ParameterName=TPDO 1 mapping
ObjectType=0x9
SubNumber=2

[1A00sub0]
ParameterName=Number of mapped objects
ObjectType=0x7
DataType=0x0005
AccessType=rw
DefaultValue=1

[1A00sub1]
ParameterName=Mapped object 1
ObjectType=0x7
DataType=0x0007
AccessType=rw
DefaultValue=0x20000010

[ManufacturerObjects]
SupportedObjects=1
1=0x2000

[2000]
ParameterName=Temperature
ObjectType=0x7
DataType=0x0003
AccessType=ro
PDOMapping=1
LowLimit=-400
HighLimit=1500
"""


def check(path: Path) -> list[dict[str, Any]]:
    result = subprocess.run([EDSC, "check", path, "--format", "json"], capture_output=True, text=True, check=False)
    return json.loads(result.stdout)["diagnostics"]


def line_of(text: str, line: str) -> int:
    return text.split("\n").index(line)


def published_form(findings: list[dict[str, Any]], path: Path) -> Counter[tuple[Any, ...]]:
    """Rule, severity, message, line and place of each finding of the file."""
    return Counter((one["rule"], SEVERITY[one["severity"]], one["message"], one["line"] - 1) for one in findings
                   if Path(one["file"]).resolve() == path.resolve())


def server_form(diagnostics: list[dict[str, Any]]) -> Counter[tuple[Any, ...]]:
    return Counter((one["code"], one["severity"], one["message"], one["range"]["start"]["line"]) for one in diagnostics)


class LanguageServer(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.client = Client(EDSC)
        self.addCleanup(self.stop)

    def stop(self) -> None:
        if self.client.process.poll() is None:
            self.assertEqual(self.client.end()[0], 0)

    def write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.write_bytes(text.encode())
        return path

    def small(self, text: str = SHEET) -> tuple[str, str]:
        path = self.write("small.eds", text)
        return self.client.open(path), text

    # Diagnostics

    def compare(self, path: Path) -> None:
        uri = self.client.open(path)
        self.assertEqual(server_form(self.client.published(uri)), published_form(check(path), path), path)

    def test_diagnostics_are_the_findings_of_check(self) -> None:
        for path in sorted((SOURCE_DIR / "eds").glob("*.eds")) + sorted((SOURCE_DIR / "tests/fixtures").glob("*.[ed][dc][sf]")):
            try:
                path.read_bytes().decode()
            except UnicodeDecodeError:
                continue  # an editor sends other text
            with self.subTest(path.name):
                self.compare(path)

    def test_columns_are_utf_16_or_utf_8(self) -> None:
        text = SHEET.replace("VendorName=é𝄞", "VendorNme=é𝄞")
        text = text.replace("DefaultValue=0\n\n[1001]", "DefaultValue=é𝄞x\n\n[1001]")
        path = self.write("small.eds", text)
        for encoding, width in (("utf-16", 4), ("utf-8", 7)):
            client = Client(EDSC, encoding=encoding)
            self.assertEqual(client.capabilities["positionEncoding"], encoding)
            found = [one for one in client.published(client.open(path)) if one["range"]["start"]["line"] == line_of(text, "DefaultValue=é𝄞x")]
            self.assertEqual([(one["range"]["start"]["character"], one["range"]["end"]["character"]) for one in found], [(13, 13 + width)])
            self.assertEqual(client.end()[0], 0)

    def test_rules_have_a_url_and_tags(self) -> None:
        uri, _ = self.small(SHEET.replace("Granularity=8\n", "Granularity=8\nGranularity=8\n"))
        found = {one["code"]: one for one in self.client.published(uri)}
        self.assertIn("#duplicate-key", found["duplicate-key"]["codeDescription"]["href"])
        self.assertEqual(found["duplicate-key"]["tags"], [1])
        self.assertEqual(found["duplicate-key"]["source"], "edsc")

    def test_a_sheet_typed_by_characters(self) -> None:
        path = self.write("small.eds", "")
        uri = self.client.open(path)
        line, character = 0, 0
        for number, c in enumerate(SHEET):
            at = {"line": line, "character": character}
            self.client.change(uri, [{"range": {"start": at, "end": at}, "text": c}])
            line, character = (line + 1, 0) if c == "\n" else (line, character + len(c.encode("utf-16-le")) // 2)
            if number % 97 == 0:
                self.client.at("completion", uri, line, character)
        path.write_bytes(SHEET.encode())
        self.assertEqual(server_form(self.client.published(uri)), published_form(check(path), path))

    def test_random_edits_equal_the_whole_text(self) -> None:
        source = random.Random(1)
        path = self.write("small.eds", SHEET)
        uri, text = self.client.open(path), SHEET
        for _ in range(40):
            lines = text.split("\n")
            first = source.randrange(len(lines))
            last = min(first + source.randrange(3), len(lines) - 1)
            start = {"line": first, "character": source.randrange(6)}
            end = {"line": last, "character": source.randrange(30)}
            if (first, start["character"]) > (last, end["character"]):
                end = start
            new = source.choice(["", "x", "\n", "[2001]\n", "𝄞", "DefaultValue=1\n"])
            clamp = lambda at: {"line": at["line"], "character": min(at["character"], len(lines[at["line"]].encode("utf-16-le")) // 2)}  # noqa: E731
            try:
                text = applied(text, [{"range": {"start": clamp(start), "end": clamp(end)}, "newText": new}])
            except UnicodeDecodeError:
                continue  # half of a surrogate pair
            self.client.change(uri, [{"range": {"start": start, "end": end}, "text": new}])
        path.write_bytes(text.encode())
        self.assertEqual(server_form(self.client.published(uri)), published_form(check(path), path))

    def test_unsaved_text_counts_for_networks_and_overlays(self) -> None:
        sheet, text = self.small()
        overlay = self.client.open(self.write("changed.overlay", "[Overlay]\nVersion=1\nBase=small.eds\n\n; wrong\n[1017]\nDefaultValue=0 => 100\n"))
        network = self.client.open(self.write("plant.json", json.dumps({"bit_rate": 125, "nodes": {"axis1": {"node_id": 5, "eds": "small.eds"}}})))
        before = server_form(self.client.published(network))
        self.assertNotIn("overlay-stale", [one["code"] for one in self.client.published(overlay)])
        self.client.replace(sheet, text.replace("DefaultValue=0\n\n[1800]", "DefaultValue=7\n\n[1800]").replace("DefaultValue=$NODEID+0x180", "DefaultValue=0x80000000"))
        self.client.published(sheet)
        self.assertIn("overlay-stale", [one["code"] for one in self.client.diagnostics[overlay]])
        self.assertNotEqual(server_form(self.client.diagnostics[network]), before)

    def test_options_have_the_findings_of_the_device(self) -> None:
        path = self.write("small.eds", SHEET)
        options = self.write("small.options.json", '{"pdo": {"mapping_abort_code": 1}, "silence": ["no-such-rule"]}')
        uri = self.client.open(options)
        self.assertEqual(server_form(self.client.published(uri)), published_form(check(path), options))
        self.assertTrue(self.client.diagnostics[uri])

    # Requests

    def test_hover(self) -> None:
        uri, text = self.small()
        mapped = self.client.at("hover", uri, line_of(text, "DefaultValue=0x20000010"), 20)["contents"]["value"]
        for word in ("2000h:00 Temperature", "INTEGER16", "bytes 0..1", "TPDO 1", "-400..1500", "od::temperature"):
            self.assertIn(word, mapped)
        cob_id = self.client.at("hover", uri, line_of(text, "DefaultValue=$NODEID+0x180"), 20)["contents"]["value"]
        self.assertIn("CAN-ID 180h + node-ID", cob_id)
        self.assertIn("CiA 301, 7.5.2.37", cob_id)
        self.assertIsNone(self.client.at("hover", uri, 1, 2))

    def test_inlay_hints(self) -> None:
        uri, text = self.small()
        hints = self.client.request("textDocument/inlayHint", {"textDocument": {"uri": uri}, "range": {
            "start": {"line": 0, "character": 0}, "end": {"line": 500, "character": 0}}})
        self.assertEqual({(one["position"]["line"], one["label"]) for one in hints}, {
            (line_of(text, "DefaultValue=0x20000010"), "= Temperature, bytes 0..1"),
            (line_of(text, "DefaultValue=$NODEID+0x180"), "= 181h..1FFh")})

    def complete(self, text: str, at: str) -> list[str]:
        """What the proposals with the label `at` insert at the cursor `|` of a text."""
        place = text.index("|")
        before = text[:place]
        self.client.replace(self.uri, text.replace("|", ""))
        items = self.client.at("completion", self.uri, before.count("\n"), len(before.rsplit("\n", 1)[-1]))
        return [one["textEdit"]["newText"] for one in items if one["label"] == at]

    def test_completion(self) -> None:
        self.uri, text = self.small()
        for line, typed, label, new in (
                ("DefaultValue=0x20000010", "DefaultValue=|", "Temperature", "0x20000010"),
                ("HighLimit=1500", "Defau|", "DefaultValue", "DefaultValue="),
                ("AccessType=ro\nPDOMapping=1", "AccessType=|\nPDOMapping=1", "rwr", "rwr"),
                ("DataType=0x0003", "DataType=|", "UNSIGNED16", "0x0006"),
                ("DefaultValue=$NODEID+0x180", "DefaultValue=|", "$NODEID+0x180", "$NODEID+0x180"),
                ("[1800sub2]", "[1800|", "1800sub2", "1800sub2]")):
            with self.subTest(typed):
                self.assertEqual(self.complete(text.replace(line, typed, 1), label), [new])

    def test_completion_in_a_network(self) -> None:
        self.write("small.eds", SHEET)
        good = '{"bit_rate": 125,\n "nodes": {"axis1": {"node_id": 5, "eds": "small.eds"}, "master": {"node_id": 1, "master": true}},\n "signals": [{"from": "axis1", "object": "x", "to": ["master"], "event": true}]}'
        self.uri = self.client.open(self.write("plant.json", good))
        self.assertEqual(self.complete(good.replace('"x"', '"|"'), "temperature"), ["temperature"])
        self.assertEqual(self.complete(good.replace('"from": "axis1"', '"from": "|'), "axis1"), ["axis1"])
        self.assertEqual(self.complete(good.replace('"node_id": 5', '"|'), "heartbeat_ms"), ["heartbeat_ms"])

    def test_options_are_completed_and_described(self) -> None:
        """Expected are texts of docs/options.md, and objects of the device beside the options."""
        self.write("small.eds", SHEET)
        good = '{"sdo": {"timeout": 500},\n "meaning": {"2000h": {"unit": "degC"}},\n "cpp": 0}'
        self.uri = self.client.open(self.write("small.options.json", good))
        for typed, label in (('{"|": 1}', "storage"), ('{"|": 1}', "meaning"), ('{"sdo": {"|": 1}}', "timeout"),
                             ('{"meaning": {"|": {}}}', "2000h"), ('{"meaning": {"2000h": {"|": 1}}}', "scale"),
                             ('{"names": {"|": "x"}}', "1018h:01")):
            with self.subTest(typed):
                self.assertEqual(self.complete(typed, label), [label])
        self.assertEqual(self.complete('{"sdo": {"|": 1}}', "scale"), [])
        self.client.replace(self.uri, good)
        page = (SOURCE_DIR / "docs/options.md").read_text(encoding="utf-8")
        (row,) = [line for line in page.splitlines() if line.startswith("| `sdo.timeout` |")]
        timeout = self.client.at("hover", self.uri, 0, good.index("timeout") + 1)["contents"]["value"]
        self.assertIn(row.split(" | ")[1], timeout)
        second = good.splitlines()[1]
        self.assertIn("2000h:00 Temperature", self.client.at("hover", self.uri, 1, second.index("2000h") + 1)["contents"]["value"])
        self.assertIn("unit of the physical value", self.client.at("hover", self.uri, 1, second.index("unit") + 1)["contents"]["value"])

    def test_deviations_are_completed_and_described(self) -> None:
        listed = subprocess.run([EDSC, "conform", "--list"], capture_output=True, text=True, check=True).stdout
        number, title = re.search(r"(?m)^  (\d+\.\d+) +(.*) \(CiA", listed).groups()
        good = '{"deviations": [{"case": "' + number + '", "reason": "x"}]}'
        self.uri = self.client.open(self.write("small.deviations.json", good))
        self.assertEqual(self.complete(good.replace(number, "|"), number), [number])
        self.assertEqual(self.complete(good.replace("reason", "|"), "source"), ["source"])
        self.client.replace(self.uri, good)
        self.assertIn(title.split("`")[0][:20], self.client.at("hover", self.uri, 0, good.index(number) + 1)["contents"]["value"])

    def test_definition_and_references(self) -> None:
        uri, text = self.small()
        network = self.client.open(self.write("plant.json", json.dumps({
            "bit_rate": 125, "nodes": {"axis1": {"node_id": 5, "eds": "small.eds"}, "master": {"node_id": 1, "master": True}},
            "signals": [{"from": "axis1", "object": "temperature", "to": ["master"], "event": True}]})))
        place = line_of(text, "DefaultValue=0x20000010")
        found = self.client.at("definition", uri, place, 20)
        self.assertEqual((found["uri"], found["range"]["start"]["line"]), (uri, line_of(text, "[2000]")))
        places = self.client.at("references", uri, line_of(text, "[2000]"), 2, context={"includeDeclaration": True})
        self.assertEqual(Counter((one["uri"], one["range"]["start"]["line"]) for one in places), Counter([
            (uri, line_of(text, "[2000]")), (uri, line_of(text, "1=0x2000")), (uri, place), (network, 0)]))

    def test_symbols_and_folding(self) -> None:
        uri, text = self.small()
        symbols = self.client.request("textDocument/documentSymbol", {"textDocument": {"uri": uri}})
        identity = next(one for one in symbols if one["name"].startswith("1018"))
        self.assertEqual([one["name"] for one in identity["children"]], [
            "1018sub0 Highest sub-index", "1018sub1 Vendor-ID", "1018sub2 Product code", "1018sub3 Revision number"])
        folds = self.client.request("textDocument/foldingRange", {"textDocument": {"uri": uri}})
        self.assertEqual(len(folds), text.count("\n[") + 1)

    def test_formatting_is_that_of_format(self) -> None:
        text = SHEET.replace("ObjectType=0x7", "ObjectType = 7")
        path = self.write("small.eds", text)
        uri = self.client.open(path)
        edits = self.client.request("textDocument/formatting", {"textDocument": {"uri": uri}, "options": {"tabSize": 2, "insertSpaces": True}})
        formatted = subprocess.run([EDSC, "format", path], capture_output=True, text=True, check=True).stdout
        self.assertEqual(applied(text, edits), formatted)

    def test_rename_renumbers(self) -> None:
        uri, text = self.small()
        edit = self.client.at("rename", uri, line_of(text, "[2000]"), 2, newName="2040")
        renamed = applied(text, edit["changes"][uri])
        self.assertEqual(renamed, text.replace("0x20000010", "0x20400010").replace("1=0x2000", "1=0x2040").replace("[2000]", "[2040]"))
        self.assertIn("already exists", self.client.error("textDocument/rename", {
            "textDocument": {"uri": uri}, "position": {"line": line_of(text, "[2000]"), "character": 2}, "newName": "1017"})["message"])

    def fixes(self, text: str, line: str) -> list[dict[str, Any]]:
        self.client.replace(self.uri, text)
        at = line_of(text, line)
        return self.client.request("textDocument/codeAction", {
            "textDocument": {"uri": self.uri}, "range": {"start": {"line": at, "character": 0}, "end": {"line": at, "character": 99}},
            "context": {"diagnostics": []}})

    def test_quick_fixes_remove_their_finding(self) -> None:
        self.uri, text = self.small()
        for rule, old, new, line in (
                ("object-list-count", "SupportedObjects=1\n1=0x2000", "SupportedObjects=4\n1=0x2000", "SupportedObjects=4"),
                ("object-not-listed", "SupportedObjects=1\n1=0x2000", "SupportedObjects=0", "[2000]"),
                ("unknown-key", "HighLimit=1500", "HighLimt=1500", "HighLimt=1500"),
                ("vendor-number", "VendorNumber=1", "VendorNumber=9", "VendorNumber=9"),
                ("duplicate-key", "Granularity=8", "Granularity=8\nGranularity=9", "Granularity=9"),
                ("pdo-count", "NrOfTXPDO=1", "NrOfTXPDO=5", "NrOfTXPDO=5"),
                ("process-data-not-mappable", "AccessType=rw\nDefaultValue=0", "AccessType=rww\nDefaultValue=0", "AccessType=rww"),
                ("sub-number", "SubNumber=2", "SubNumber=9", "SubNumber=9")):
            with self.subTest(rule):
                wrong = text.replace(old, new, 1)
                self.assertNotEqual(wrong, text)
                actions = [one for one in self.fixes(wrong, line) if one.get("isPreferred")]
                self.assertIn(rule, [one["code"] for one in self.client.published(self.uri)])
                self.assertTrue(actions)
                edits = actions[0]["edit"]["changes"][self.uri]
                path = self.write("small.eds", applied(wrong, edits))
                self.assertNotIn(rule, [one["rule"] for one in check(path)])

    def test_a_client_may_ask_for_the_edit_later(self) -> None:
        wrong = SHEET.replace("NrOfTXPDO=1", "NrOfTXPDO=5")
        path = self.write("small.eds", wrong)
        client = Client(EDSC, more={"textDocument": {"codeAction": {"resolveSupport": {"properties": ["edit"]}}}})
        uri, at = client.open(path), line_of(wrong, "NrOfTXPDO=5")
        offered = client.request("textDocument/codeAction", {
            "textDocument": {"uri": uri}, "context": {"diagnostics": []},
            "range": {"start": {"line": at, "character": 0}, "end": {"line": at, "character": 99}}})
        action = next(one for one in offered if one.get("isPreferred"))
        self.assertNotIn("edit", action)
        edit = client.request("codeAction/resolve", action)["edit"]
        self.assertEqual(applied(wrong, edit["changes"][uri]), SHEET)
        self.assertIn("code", client.error("codeAction/resolve", {"data": {"uri": uri, "changes": [{"do": "x"}]}}))
        self.assertEqual(client.end()[0], 0)

    def test_allow_comment_is_accepted(self) -> None:
        self.uri, text = self.small()
        wrong = text.replace("VendorNumber=1", "VendorNumber=9")
        allow = next(one for one in self.fixes(wrong, "VendorNumber=9") if one["title"].startswith("Allow vendor-number"))
        path = self.write("small.eds", applied(wrong, allow["edit"]["changes"][self.uri]))
        self.assertNotIn("vendor-number", [one["rule"] for one in check(path)])

    def test_the_fix_in_an_overlay_repairs_the_device(self) -> None:
        wrong = SHEET.replace("NrOfTXPDO=1", "NrOfTXPDO=5")
        path = self.write("small.eds", wrong)
        self.uri = self.client.open(path)
        action = next(one for one in self.fixes(wrong, "NrOfTXPDO=5") if "small.overlay" in one["title"])
        created, edit = action["edit"]["documentChanges"]
        self.assertEqual((created["kind"], created["uri"]), ("create", (self.folder / "small.overlay").resolve().as_uri()))
        overlay = self.write("small.overlay", applied("", edit["edits"]))
        self.assertNotIn("pdo-count", [one["rule"] for one in check(overlay)])

    def test_fix_all_corrects_lists_and_counts(self) -> None:
        self.uri, text = self.small()
        wrong = text.replace("SupportedObjects=1\n1=0x2000", "SupportedObjects=9\n1=0x2000").replace("NrOfTXPDO=1", "NrOfTXPDO=5")
        self.client.replace(self.uri, wrong)
        actions = self.client.request("textDocument/codeAction", {
            "textDocument": {"uri": self.uri}, "range": {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}},
            "context": {"diagnostics": [], "only": ["source.fixAll"]}})
        self.assertEqual([one["kind"] for one in actions], ["source.fixAll.edsc"])
        self.assertEqual(applied(wrong, actions[0]["edit"]["changes"][self.uri]), text)

    @unittest.skipUnless(shutil.which("git"), "git is needed")
    def test_lens_names_what_breaks(self) -> None:
        path = self.write("small.eds", SHEET)
        git = ["git", "-C", self.folder, "-c", "user.name=x", "-c", "user.email=x@example.org"]
        for words in (["init", "-q"], ["add", "small.eds"], ["commit", "-q", "-m", "x"]):
            subprocess.run([*git, *words], check=True)
        uri = self.client.open(path)
        lenses = lambda: self.client.request("textDocument/codeLens", {"textDocument": {"uri": uri}})  # noqa: E731
        self.assertEqual(lenses(), [])
        self.client.replace(uri, SHEET.replace("DataType=0x0003", "DataType=0x0004"))
        self.assertTrue(any("breaks masters" in one["command"]["title"] for one in lenses()))

    # Robustness

    def test_hostile_messages_do_not_end_the_server(self) -> None:
        uri, text = self.small()
        deep = b"[" * 100000
        for data in (b"Content-Length: x\r\n\r\n", b"\r\n\r\n", b"Content-Length: 3\r\n\r\n{x}", b"Content-Length: 2\r\n\r\n[]",
                     b"Content-Length: %d\r\n\r\n%s" % (len(deep), deep), b"x" * 9000, b"Content-Length: -1\r\n\r\n",
                     b"Content-Length: 99999999999999999999\r\n\r\n", b"Content-Length: 4\r\n\r\n\xff\xfe\x00{"):
            self.client.send_bytes(data)
        for method, params in (("textDocument/hover", {}), ("textDocument/hover", []), ("textDocument/hover", None),
                               ("textDocument/hover", {"textDocument": {"uri": uri}, "position": {"line": -1, "character": "x"}}),
                               ("textDocument/rename", {"textDocument": {"uri": uri}, "position": {"line": 0, "character": 0}, "newName": 1}),
                               ("no/such/method", {}), ("textDocument/didOpen", {"textDocument": 1})):
            self.assertIn("code", self.client.error(method, params), method)
        for method in ("textDocument/didChange", "textDocument/didOpen", "textDocument/didClose"):
            self.client.notify(method, {"textDocument": {"uri": "file:///absent.eds"}, "contentChanges": [{"range": {}, "text": "x"}]})
        far = {"line": 2**31, "character": 2**31}
        self.client.change(uri, [{"range": {"start": far, "end": {"line": 0, "character": 0}}, "text": "; end"}])
        for method in ("hover", "completion", "definition", "prepareRename"):
            self.client.at(method, uri, 2**31, 2**31)
        self.assertTrue(self.client.published(uri))
        code, log = self.client.end()
        self.assertEqual(code, 0)
        self.assertIn("is not JSON", log)

    def test_end_without_shutdown_is_an_error(self) -> None:
        self.client.notify("exit", None)
        self.assertEqual(self.client.wait()[0], 1)

    def test_an_interrupt_ends_the_server(self) -> None:
        self.client.process.send_signal(signal.SIGINT)
        self.assertEqual(self.client.process.wait(60), 130)
        self.client.wait()

    def test_requests_before_initialize_are_rejected(self) -> None:
        client = Client(EDSC, initialize=False)
        self.assertEqual(client.error("textDocument/hover", {})["code"], -32002)
        client.notify("exit", None)
        self.assertEqual(client.wait()[0], 1)

    def test_random_requests_at_random_texts(self) -> None:
        source = random.Random(2)
        uri, _ = self.small()
        text = CPC.read_text(encoding="utf-8")[:20000]
        for _ in range(30):
            first = source.randrange(len(text))
            cut = text[:first] + text[first + source.randrange(200):]
            self.client.replace(uri, cut)
            line = source.randrange(cut.count("\n") + 1)
            for method in ("hover", "completion", "definition", "prepareRename"):
                self.client.at(method, uri, line, source.randrange(40))
            self.fixes_at(uri, line)
        self.client.published(uri)

    def fixes_at(self, uri: str, line: int) -> None:
        at = {"line": line, "character": 0}
        self.client.request("textDocument/codeAction", {"textDocument": {"uri": uri}, "range": {"start": at, "end": at}, "context": {"diagnostics": []}})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
