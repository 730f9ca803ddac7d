#!/usr/bin/env python3
"""Each rule reports its wrong example, at the position in the example, and not its right one; docs/rules.md has all examples.

    rules_test.py SOURCE_DIR EDSC [--write]      --write generates docs/rules.md

generator/rules/check_examples.txt has for each rule `@ id`, then `@@ bad` and `@@ good`, each followed by its changes of base.eds; a rule may have
several such pairs:
- `[section]` names the section of the lines below; a new one is added at the end, and to its object list
- `Key=value` replaces the line with this key, or adds one; `+line` adds it as it is; `-Key` and `-[section]` remove
- a new object with missing keys is a rw VAR of UNSIGNED8; SubNumber is the number of sub-objects unless it is set
- a line with only `^` means that the position of the finding is in the line above, in this column; without it, in line 1
Words after `bad` and `good`: `raw` (the whole file, not a change), `escaped` (Python's escapes, and `x{n}` for n times
x), `file=NAME`, `file=example.overlay` (an overlay, with base.eds beside it), `column=N` (of the line with the caret), `command=generate|format` (instead of check), `missing` (no
file), `strict` (with `--strict`), `network` (a network file; its nodes are tests/generator/network/node.eds, and it has findings of this rule only). `@@ bad options` is the options file. `severity=S` is the severity of the finding if the rule has two.

Each finding of an example must be of a rule of the table, with a severity of its row.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

NETWORK_SHEET = Path(__file__).parent.parent / "network/node.eds"
FINDING = re.compile(r"^(.*?):(\d+):(\d+): (error|warning|note): (.*) \[([a-z0-9-]+)\]$", re.MULTILINE)
CARET = re.compile(r"^ *\^$")
OBJECT = re.compile(r"^([0-9A-F]{4})(sub([0-9A-F]{1,2})|Name|Value)?$", re.IGNORECASE)
NEW_OBJECT_KEYS = {"ParameterName": "Example", "ObjectType": "0x7", "DataType": "0x0005", "AccessType": "rw"}


@dataclass
class Line:
    text: str
    column: int | None = None  # of the expected finding


@dataclass
class Section:
    header: Line
    lines: list[Line] = field(default_factory=list)

    @property
    def name(self) -> str:
        return self.header.text.strip("[]")

    def find(self, key: str) -> Line | None:
        return next((line for line in self.lines if line.text.split("=")[0] == key), None)

    def set(self, key: str, value: str, column: int | None = None) -> None:
        line = self.find(key)
        if line is None:
            self.add(line := Line(""))
        line.text, line.column = f"{key}={value}", column

    def add(self, line: Line) -> None:
        end = len(self.lines)
        while end > 0 and not self.lines[end - 1].text:
            end -= 1
        self.lines.insert(end, line)


@dataclass
class Block:
    words: list[str]
    lines: list[Line] = field(default_factory=list)

    def option(self, name: str, default: str) -> str:
        return next((word.split("=")[1] for word in self.words if word.startswith(f"{name}=")), default)


@dataclass
class Example:
    rule: str
    blocks: dict[str, Block] = field(default_factory=dict)  # "bad", "good", "bad options", "good options"


def read_examples(path: Path) -> dict[str, list[Example]]:
    examples: dict[str, list[Example]] = {}
    block = Block([])
    for text in path.read_text(encoding="utf-8").splitlines():
        if text.startswith("@@ "):
            words = text[3:].split()
            name = f"{words[0]} options" if "options" in words else words[0]
            if name == "bad" and example.blocks:
                example = Example(example.rule)
                examples[example.rule].append(example)
            block = example.blocks[name] = Block(words)
        elif text.startswith("@ "):
            assert text[2:] not in examples, text
            example = Example(text[2:])
            examples[example.rule] = [example]
        elif CARET.match(text):
            block.lines[-1].column = text.index("^") + 1
        else:
            block.lines.append(Line(text))
    for block in (block for pairs in examples.values() for example in pairs for block in example.blocks.values()):
        while block.lines and not block.lines[-1].text:
            block.lines.pop()
    return examples


class Sheet:
    """The base EDS while changes are applied."""

    def __init__(self, text: str) -> None:
        self.head: list[Line] = []
        self.sections: list[Section] = []
        for line in map(Line, text.splitlines()):
            if line.text.startswith("["):
                self.sections.append(Section(line))
            else:
                (self.sections[-1].lines if self.sections else self.head).append(line)

    def find(self, name: str) -> Section | None:
        return next((section for section in self.sections if section.name == name), None)

    def apply(self, patch: list[Line]) -> None:
        section, added, touched, own_count = None, [], set(), set()
        for line in patch:
            text = line.text
            if text.startswith("-["):
                gone = self.find(text[2:-1])
                assert gone, text
                self.sections.remove(gone)
                touched.add(gone.name[:4])
            elif text.startswith("["):
                section = self.find(text[1:-1])
                if section is None:
                    section = Section(Line(text))
                    self.sections.append(section)
                    added.append(section)
                    touched.add(section.name[:4])
                section.header.column = line.column
            elif text.startswith("-"):
                gone_line = section.find(text[1:])
                assert gone_line, text
                section.lines.remove(gone_line)
            elif text.startswith("+"):
                section.add(Line(text[1:], line.column and line.column - 1))
            elif "=" not in text or text.startswith(";"):
                section.lines.insert(0, line)
            else:
                key, value = text.split("=", 1)
                section.set(key, value, line.column)
                if key == "SubNumber":
                    own_count.add(section.name)
        for section in added:
            self.complete(section)
        for name in touched - own_count:
            self.count(name)

    def complete(self, section: Section) -> None:
        match = OBJECT.match(section.name)
        if not match or match[2] and not match[3]:
            return
        group = any(line.text in ("ObjectType=0x8", "ObjectType=0x9") for line in section.lines)
        for key, value in NEW_OBJECT_KEYS.items():
            of_no_group = group and key in ("DataType", "AccessType") and not section.find("CompactSubObj")
            if not section.find(key) and not of_no_group:
                section.set(key, value)
        if not match[3]:
            self.list_object(section.name)

    def list_object(self, index: str) -> None:
        objects = self.find("ManufacturerObjects" if "2" <= index[0] <= "5" else "OptionalObjects")
        if any(line.text.lower().endswith(f"=0x{index}".lower()) for name in ("OptionalObjects", "ManufacturerObjects")
               for line in self.find(name).lines):
            return
        count = sum(line.text[:1].isdigit() for line in objects.lines) + 1
        objects.set(str(count), f"0x{index}")
        objects.set("SupportedObjects", str(count))

    def count(self, index: str) -> None:
        section = self.find(index)
        subs = sum(bool(re.match(rf"^{index}sub", s.name)) for s in self.sections)
        if section and subs and not section.find("CompactSubObj"):
            section.set("SubNumber", str(subs), (section.find("SubNumber") or Line("")).column)

    def lines(self) -> list[Line]:
        return self.head + [line for section in self.sections for line in [section.header, *section.lines]]


def unescape(text: str) -> str:
    text = re.sub(r"(\\x..|.)\{(\d+)\}", lambda m: m[1] * int(m[2]), text)
    return text.encode("latin-1").decode("unicode_escape")


def lines_of(block: Block, base: str, file: str) -> list[Line]:
    lines = [Line(unescape(line.text) if "escaped" in block.words else line.text, line.column) for line in block.lines]
    if "raw" in block.words or "network" in block.words:
        return lines
    sheet = Sheet(base.replace("FileName=example.eds", f"FileName={file}"))
    sheet.apply(lines)
    return sheet.lines()


@dataclass(frozen=True)
class Place:
    line: int
    column: int


def run(edsc: Path, folder: Path, example: Example, kind: str, base: str) -> tuple[list[tuple[str, str, Place]], Place]:
    """The findings of edsc in an example, and the position of its caret."""
    block = example.blocks.get(kind, Block([kind]))
    is_network = "network" in block.words
    file = "plant.json" if is_network else block.option("file", "example.eds")
    if is_network:
        shutil.copy(NETWORK_SHEET, folder)
    lines = lines_of(block, base, file)
    if "missing" not in block.words:
        (folder / file).write_text("".join(f"{line.text}\n" for line in lines), encoding="utf-8")
    marked = lines
    if options := example.blocks.get(f"{kind} options"):
        name = Path(file).with_suffix(".options.json")
        (folder / name).write_text("".join(f"{line.text}\n" for line in options.lines), encoding="utf-8")
        if any(line.column for line in options.lines):
            marked = options.lines
    if file.endswith(".overlay"):
        (folder / "base.eds").write_text(base, encoding="utf-8")
    command = block.option("command", "check")
    arguments = {"check": ["--all-findings"], "generate": ["-o", "out"], "format": ["--check"]}[command]
    words = ["network", "check", file] if is_network else [command, file, *arguments]
    is_strict = "strict" in block.words
    if is_strict:
        words.append("--strict")
    result = subprocess.run([edsc, *words], cwd=folder, capture_output=True, text=True, timeout=600)
    column = int(block.option("column", "0"))
    place = next((Place(n, column or line.column) for n, line in enumerate(marked, 1) if line.column), Place(1, 1))
    output = result.stdout + result.stderr
    severity_of_row = {"error": "warning"} if is_strict else {}
    return [(m[6], severity_of_row.get(m[4], m[4]), Place(int(m[2]), int(m[3]))) for m in FINDING.finditer(output)], place


def check_example(edsc: Path, example: Example, base: str, severities: dict[str, list[str]]) -> list[str]:
    problems = []
    for kind in ("bad", "good"):
        with tempfile.TemporaryDirectory() as folder:
            found, expected = run(edsc, Path(folder), example, kind, base)
        for rule, severity, _ in found:
            if severity not in severities.get(rule, []):
                problems.append(f"{example.rule}: {rule} is reported as a {severity}, which its row does not have")
        wanted = example.blocks.get(kind, Block([])).option("severity", "")
        places = [place for rule, severity, place in found if rule == example.rule and severity.startswith(wanted)]
        if kind == "good" and places:
            problems.append(f"{example.rule}: reported for the right example at {places}")
        others = sorted({rule for rule, severity, _ in found if severity != "note"} - {example.rule})
        if others and "network" in example.blocks[kind].words:
            problems.append(f"{example.rule}: the {kind} network has findings of other rules: {others}")
        if kind == "bad" and expected not in places:
            problems.append(f"{example.rule}: expected for the wrong example at {expected}, got {found}")
    return problems


def code_block(block: Block | None) -> list[str]:
    if block is None or not block.lines:
        return []
    lines = ["```"]
    for line in block.lines:
        lines.append(line.text)
        if line.column:
            lines.append(" " * (line.column - 1) + "^")
    return [*lines, "```", ""]


INTRODUCTION = """# Rules

The rules of `edsc check`. An error stops `edsc generate`; a warning reports a fault or an assumption; a note is for
information and does not change the exit code, not even with `--strict`. `--silence RULE` and `silence` in the
[options file](options.md) disable a rule for `check`; for `generate`, only its warnings and notes. `allow` in the options
file, or a comment in the EDS, allows [expected findings](options.md#allowed-findings). `edsc check --list-rules` prints this
table, `--explain RULE` one row of it with its examples. A finding that follows from another one is counted below it;
`edsc check --all-findings` lists it.

The examples are changes to an EDS without findings: a line replaces the one with the same key, a section that begins with
`-` is removed, and `^` marks the position of the finding. `tests/generator/lint/rules_test.py` runs the examples of
`generator/rules/check_examples.txt` and writes this page from them with `--write`.
"""


def severity_of(rule: dict[str, str]) -> str:
    return " or ".join(rule["severities"])


def document(rules: list[dict[str, str]], examples: dict[str, list[Example]]) -> str:
    out = [INTRODUCTION, f"{len(rules)} rules:", "", "| rule | | meaning | source |", "|---|---|---|---|"]
    for rule in rules:
        out.append(f"| [{rule['id']}](#{rule['id']}) | {severity_of(rule)} | {rule['meaning']} | {rule['source']} |")
    for rule in rules:
        out += ["", f"## {rule['id']}", "", f"{severity_of(rule).capitalize()}: {rule['meaning']} ({rule['source']}).", ""]
        for row in rule["consequences"]:
            links = ", ".join(f"[{one}](#{one})" for one in row["rules"])
            out += [f"May cause, in the same {row['within']}: {links}.", ""]
        for example in examples[rule["id"]]:
            for kind, word in (("bad", "Wrong"), ("good", "Right")):
                blocks = [*code_block(example.blocks.get(kind)), *code_block(example.blocks.get(f"{kind} options"))]
                if blocks:
                    out += [f"{word}:", "", *blocks]
        while not out[-1]:
            out.pop()
    return "\n".join(out) + "\n"


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    folder = Path(__file__).parent
    base = (folder / "base.eds").read_text(encoding="utf-8")
    examples = read_examples(source / "generator/rules/check_examples.txt")
    listed = subprocess.run([edsc, "check", "--list-rules", "--format", "json"], check=True, capture_output=True)
    rules = json.loads(listed.stdout)["rules"]
    ids = [rule["id"] for rule in rules]
    severities = {rule["id"]: rule["severities"] for rule in rules}
    problems = [f"{rule}: no example" for rule in ids if rule not in examples]
    problems += [f"{rule}: example of an unknown rule" for rule in examples if rule not in ids]
    clean = subprocess.run([edsc, "check", "base.eds", "--silence", "file-name"], cwd=folder, capture_output=True,
                           text=True)
    if clean.stdout.strip():
        problems.append(f"base.eds has findings:\n{clean.stdout}")
    for example in (example for pairs in examples.values() for example in pairs):
        problems += check_example(edsc, example, base, severities)
    if not any("no example" in problem for problem in problems):
        page, text = source / "docs" / "rules.md", document(rules, examples)
        if "--write" in sys.argv:
            page.write_text(text, encoding="utf-8")
        elif not page.exists() or page.read_text(encoding="utf-8") != text:
            problems.append("docs/rules.md is not up to date: run rules_test.py with --write")
    print("\n".join(problems))
    print(f"{len(rules)} rules, {len(examples)} examples, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
