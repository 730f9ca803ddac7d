#!/usr/bin/env python3
"""Each fix that the language server offers removes its finding, and adds none.

    fixes_test.py SOURCE_DIR EDSC

Faults are planted in the EDS files of eds/, as planted_faults_test.py does; each fix that is offered for the rule of a fault is applied, and
`edsc check` reads the result. A rule with a fix of which no fault is planted is a failure.
"""

from __future__ import annotations

import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lint"))

from lsp_client import Client, applied  # noqa: E402
from planted_faults_test import SINGLE, SYSTEMATIC, Change, add, entry, replace  # noqa: E402

SEED = 23
FILES_PER_FAULT = 2

# Faults that have a fix, besides those of planted_faults_test.py.
MORE: list[tuple[str, Change]] = [
    ("process-data-not-mappable", replace(r"^AccessType=rw\n((?:[^\[\n].*\n)*?)PDOMapping=0$", r"AccessType=rww\n\1PDOMapping=0")),
    ("entry-count", add("[5FF0]\nParameterName=Planted\nObjectType=0x8\nDataType=0x0005\nAccessType=ro\nCompactSubObj=3\n"
                        "[5FF0Name]\nNrOfEntries=2\n2=Second")),
    ("default-sdo-cob-id", replace(r"^DefaultValue=\$NODEID\+0x600$", "DefaultValue=0x600")),
    ("unknown-key", replace(r"^DataType=", "DataTyp=")),
    ("access-type", entry("1000", "AccessType", "r")),
    ("data-type", entry("1000", "DataType", "UNSIGNED32")),
    ("number-spelling", replace(r"^DefaultValue=(\d+)$", r"DefaultValue=\1.0")),
]
# One finding for all places of a file, of which a fix corrects one.
OF_THE_FILE = {"shifted-data-types"}
# Its remedy has no place in the file: `edsc check --repair` states it in the header of an overlay.
WITHOUT_PLACE = {"sub-index-base"}


def rules_with_fixes(source: Path) -> set[str]:
    """Those of the table of fixes, and those that come with a remedy."""
    rules = set(re.findall(r'^      \{"([a-z0-9-]+)", ', (source / "generator/change/fixes.cpp").read_text(encoding="utf-8"), re.MULTILINE))
    for path in (source / "generator").rglob("*.cpp"):
        rules |= set(re.findall(r'\.offer_(?:value|key)\(\s*"([a-z0-9-]+)"', path.read_text(encoding="utf-8")))
    return rules


class Server:
    def __init__(self, edsc: Path, folder: Path) -> None:
        self.edsc, self.folder, self.client = edsc, folder, Client(edsc)
        self.folders = 0
        self.problems: list[str] = []
        self.applied: Counter[str] = Counter()

    def new_folder(self) -> Path:
        """The server has not seen a file in it."""
        self.folders += 1
        folder = self.folder / str(self.folders)
        folder.mkdir()
        return folder

    def findings(self, path: Path) -> list[dict[str, Any]]:
        result = subprocess.run([self.edsc, "check", path, "--format", "json"], capture_output=True, text=True, check=False)
        return json.loads(result.stdout)["diagnostics"]

    def try_fixes(self, rule: str, path: Path, text: str) -> None:
        """Applies each fix of the findings of a rule."""
        path.write_text(text, encoding="utf-8")
        before = self.findings(path)
        uri = self.client.open(path)
        for found in [one for one in self.client.published(uri) if one["code"] == rule][:3]:
            actions = self.client.request("textDocument/codeAction", {
                "textDocument": {"uri": uri}, "range": found["range"], "context": {"diagnostics": [found], "only": ["quickfix"]}})
            for action in actions:
                edits = action.get("edit", {}).get("changes", {}).get(uri)
                if edits is None or action["title"].startswith("Allow "):
                    continue
                self.applied[rule] += 1
                path.write_text(applied(text, edits), encoding="utf-8")
                self.compare(rule, f"{path.name}, {action['title']!r}", before, self.findings(path))
        self.client.notify("textDocument/didClose", {"textDocument": {"uri": uri}})

    def compare(self, rule: str, what: str, before: list[dict[str, Any]], after_it: list[dict[str, Any]]) -> None:
        of_rule = [sum(1 + len(one["notes"]) for one in findings if one["rule"] == rule) for findings in (before, after_it)]
        if of_rule[1] >= of_rule[0] and rule not in OF_THE_FILE:
            self.problems.append(f"{rule}: {what}: {of_rule[0]} places before, {of_rule[1]} after")
        errors = [Counter(one["rule"] for one in findings if one["severity"] == "error") for findings in (before, after_it)]
        if errors[1] - errors[0]:
            self.problems.append(f"{rule}: {what}: adds {dict(errors[1] - errors[0])}")

    def plant(self, rule: str, change: Change, sheets: dict[str, str], chance: random.Random) -> None:
        names = [name for name, text in sheets.items() if change(text, random.Random(SEED)) not in (None, text)]
        for name in chance.sample(names, min(FILES_PER_FAULT, len(names))):
            text = change(sheets[name], chance)
            assert text is not None
            self.try_fixes(rule, self.new_folder() / name, text)


def overlay_fixes(server: Server, sheet: str) -> None:
    (server.folder / "base.eds").write_text(sheet, encoding="utf-8")
    vendor = re.search(r"^VendorName=(.*)$", sheet, re.MULTILINE)
    assert vendor is not None
    server.try_fixes("overlay-obsolete", server.folder / "planted.overlay",
                     f"[Overlay]\nVersion=1\nBase=base.eds\n; as printed on the device\n[DeviceInfo]\nVendorName=Old => {vendor[1]}\n")


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    sheets = {path.name: path.read_text(encoding="utf-8") for path in sorted((source / "eds").glob("*.eds"))}
    expected = rules_with_fixes(source) - WITHOUT_PLACE
    chance = random.Random(SEED)
    with tempfile.TemporaryDirectory() as folder:
        server = Server(edsc, Path(folder))
        faults = SINGLE + MORE + [(rule, change) for _, rule, change in SYSTEMATIC]
        for rule, change in faults:
            if rule in expected:
                server.plant(rule, change, sheets, chance)
        overlay_fixes(server, next(iter(sheets.values())))
        server.client.end()
    problems = server.problems
    problems += [f"{rule} has a fix, but no planted fault was offered one" for rule in sorted(expected - set(server.applied))]
    print("\n".join(problems))
    print(f"{sum(server.applied.values())} fixes of {len(server.applied)} rules applied; {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
