#!/usr/bin/env python3
"""Each behaviour that a manual describes has a test or a reason; docs/developers/manuals.md lists all of them.

    manuals_test.py SOURCE_DIR [--write]      --write generates docs/developers/manuals.md

NNN.md has the statements of manual NNN, in one `## HEADING` per section of the manual:
- `- [NNN.k] text` is an item, one per line.
- `- again: NNN.3, NNN.17` names statements of this section that are items of another section.
- `- none: REASON` is the only line of a section that has nothing to state.
- `## Contradictions and misprints` is the last section, which the manual does not have. A file without it is in the old
  format: its sections are not checked.
If ../shared/seeds has the text of the manual, the sections are compared with its table of contents and its headings.

- A test that shows items lists them in the lines directly above it: `// shows 003.47, 004.58..004.66` above a TEST of
  GoogleTest, `# shows ...` in a trace, or above a function or the first statement of a Python test.
- `// open ...` is above a test that does not pass yet and therefore has a name with DISABLED_.
- out_of_reach.tsv: numbers, one of KINDS, reason.
- units.tsv: the units of the EDS files, as the manuals print them (units.py).
- readings.tsv: numbers, and the reading of a statement that is unclear or contradicts another one.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

import value_only
from headings import compare_with_text
from units import check_units

MANUALS = ("000", "001", "002", "003", "004")
SHOWN = "a test verifies the statement with frames or with the live object dictionary"
KINDS = {
    "value only": "the object holds its value and has no effect; the reason names what a simulation cannot have",
    "out of reach": "no node can show it: hardware, a tool of the vendor, a rule for people, or the text of the manual itself",
    "open": "not implemented yet, or not as the manual says",
}
MISPRINTS = "Contradictions and misprints"
NUMBER = re.compile(r"(\d{3})\.(\d+)(?:\.\.\1\.(\d+))?")
ITEM = re.compile(r"- \[(\d{3}\.\d+)\] (.+)")
AGAIN = re.compile(r"- again: (.+)")
NONE = re.compile(r"- none: (.+)")
HEADING = re.compile(r"#+ (.+)")
ANNOTATION = re.compile(r"\s*(?://|#) (shows|open) (\d{3}\.\d.*)")
CPP_TEST = re.compile(r"(?:TYPED_)?TEST(?:_[FP])?\((\w+), (\w+)\)")
PYTHON_TEST = re.compile(r"def (\w+)\(")


@dataclass
class Item:
    number: str
    text: str
    heading: str
    tests: list[str] = field(default_factory=list)
    kind: str = ""
    reason: str = ""
    reading: str = ""

    @property
    def state(self) -> str:
        return self.kind or ("shown" if self.tests else "missing")


def numbers_in(text: str) -> list[str]:
    """`003.1, 003.4..003.6` as single numbers."""
    if not all(NUMBER.fullmatch(part) for part in text.split(", ")):
        raise ValueError(f"'{text}' is not a list of numbers")
    return [f"{m[1]}.{n}" for m in NUMBER.finditer(text) for n in range(int(m[2]), int(m[3] or m[2]) + 1)]


@dataclass
class Section:
    heading: str
    own: list[str] = field(default_factory=list)    # numbers of its items
    again: list[str] = field(default_factory=list)  # numbers of items of other sections
    none: list[str] = field(default_factory=list)   # reasons of lines `- none:`


@dataclass
class Manual:
    name: str
    title: str
    sections: list[Section] = field(default_factory=list)


def read_manual(path: Path, items: dict[str, Item], problems: list[str]) -> Manual:
    lines = path.read_text(encoding="utf-8").splitlines()
    manual = Manual(path.stem, lines[0].removeprefix("# "))
    for count, line in enumerate(lines[1:], 2):
        if match := HEADING.fullmatch(line):
            manual.sections.append(Section(match[1]))
            continue
        if not line.startswith("- "):
            continue
        if not manual.sections:
            problems.append(f"{path.name}:{count}: not in a section")
            break
        section = manual.sections[-1]
        if match := ITEM.fullmatch(line):
            if match[1] in items:
                problems.append(f"duplicate item [{match[1]}]")
            if not match[1].startswith(path.stem):
                problems.append(f"{path.name}: [{match[1]}] belongs to another manual")
            items[match[1]] = Item(match[1], match[2], section.heading)
            section.own.append(match[1])
        elif match := AGAIN.fullmatch(line):
            section.again += numbers_in(match[1])
        elif match := NONE.fullmatch(line):
            section.none.append(match[1])
        else:
            problems.append(f"{path.name}:{count}: missing item number: {line}")
    return manual


def check_sections(manual: Manual, items: dict[str, Item], problems: list[str]) -> None:
    for section in manual.sections:
        place = f"{manual.name}.md, {section.heading}"
        statements = section.own + section.again
        if not statements and not section.none:
            problems.append(f"{place}: has neither an item nor a line `- none:`")
        if len(section.none) > 1 or (section.none and statements):
            problems.append(f"{place}: `- none:` is not its only line")
        for number in section.again:
            if number not in items or not number.startswith(manual.name):
                problems.append(f"{place}: [{number}] does not exist")
        problems += [f"{place}: [{number}] is named twice" for number in sorted(set(statements))
                     if statements.count(number) > 1]
    if manual.sections[-1].heading != MISPRINTS:
        problems.append(f"{manual.name}.md: `{MISPRINTS}` is not the last section")


def read_rows(path: Path, columns: int, items: dict[str, Item], problems: list[str]) -> list[tuple[Item, list[str]]]:
    rows = []
    for count, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        cells = line.split("\t")
        if len(cells) != columns:
            problems.append(f"{path.name}:{count}: {len(cells)} columns")
            continue
        for number in numbers_in(cells[0]):
            if number in items:
                rows.append((items[number], cells[1:]))
            else:
                problems.append(f"{path.name}:{count}: [{number}] does not exist")
    return rows


def test_below(path: Path, lines: list[str], at: int) -> str | None:
    """The test of an annotation in line `at`."""
    if path.suffix == ".trace":
        return f"{path.stem} (trace)"
    while at < len(lines) and lines[at].lstrip().startswith(("//", "#")):
        at += 1
    if at == len(lines):
        return None
    if path.suffix == ".cpp":
        match = CPP_TEST.match(lines[at])
        return f"{match[1]}.{match[2]}" if match else None
    match = PYTHON_TEST.match(lines[at])
    return f"{path.name}, {match[1]}" if match else None


def read_tests(tests: Path, items: dict[str, Item], problems: list[str]) -> None:
    built = "".join(path.read_text(encoding="utf-8") for path in tests.rglob("CMakeLists.txt"))
    for path in sorted(tests.rglob("*")):
        if path.suffix not in (".cpp", ".py", ".trace") or path == Path(__file__).resolve():
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        for at, line in enumerate(lines):
            match = ANNOTATION.fullmatch(line)
            if not match:
                continue
            place = f"{path.relative_to(tests)}:{at + 1}"
            test = test_below(path, lines, at)
            if test is None:
                problems.append(f"{place}: no test follows")
                continue
            if path.suffix != ".trace" and path.name not in built:
                problems.append(f"{place}: no CMakeLists.txt names {path.name}")
            disabled = ".DISABLED_" in test
            if disabled != (match[1] == "open"):
                problems.append(f"{place}: {test} is{'' if disabled else ' not'} disabled, but `{match[1]}`")
            for number in numbers_in(match[2]):
                item = items.get(number)
                if item is None:
                    problems.append(f"{place}: [{number}] does not exist")
                elif test not in item.tests:
                    item.tests.append(test)
                    if disabled and item.kind != "open":
                        problems.append(f"{place}: [{number}] is not `open` in out_of_reach.tsv")
                    elif not disabled and item.kind:
                        problems.append(f"{place}: [{number}] is shown, but is `{item.kind}` in out_of_reach.tsv")


INTRODUCTION = """# Manuals

The statements in the manuals of the five reference devices, and the test that verifies each with the device generated by
edsc. `tests/manuals/manuals_test.py --write` generates this page from the items, readings and reasons in `tests/manuals` and
from the annotations of the tests. Each section of a manual is listed, also if it states nothing about the device. A statement
that a manual repeats is one item; the other sections count it again. A reading states how an unclear item is interpreted or
shown. Each statement is in one of these states:
"""


VALUE_ONLY = """SDO and PDOs read and write these objects. They have no other effect. Objects in 1000h to 1FFFh are not listed.
The test `value_only` compares the list with the objects that the application uses while all tests run."""


def cell(text: str) -> str:
    return re.sub(r"([|<>])", r"\\\1", text)


def describe(item: Item) -> str:
    tests = ", ".join(f"`{test}`" for test in sorted(item.tests))
    parts = [f"{item.kind}: {cell(item.reason)}"] if item.kind else []
    parts += [tests] if tests else []
    parts += [f"Reading: {cell(item.reading)}"] if item.reading else []
    return ". ".join(part.rstrip(".") for part in parts)


def count(items: list[Item], state: str) -> int:
    return sum(item.state == state for item in items)


def counts(items: list[Item]) -> str:
    return " | ".join(str(count(items, state)) for state in ("shown", *KINDS))


def table(*header: str) -> list[str]:
    return ["", f"| {' | '.join(header)} |", "|---" * len(header) + "|"]


def document(source: Path, manuals: list[Manual], items: dict[str, Item], problems: list[str]) -> str:
    states = ("shown", *KINDS)
    out = [INTRODUCTION, f"- shown: {SHOWN}."]
    out += [f"- {kind}: {meaning}." for kind, meaning in KINDS.items()]
    out += table("manual", "items", *states)
    for name in [*MANUALS, ""]:
        own = [item for item in items.values() if item.number.startswith(name)]
        out.append(f"| {name or 'all'} | {len(own)} | {counts(own)} |")
    for manual in manuals:
        out += ["", f"## {manual.title}", *table("section", "statements", *states)]
        for section in manual.sections:
            own = [items[number] for number in section.own + section.again if number in items]
            reason = f" ({section.none[0]})" if section.none else ""
            out.append(f"| {cell(section.heading + reason)} | {len(own)} | {counts(own)} |")
        for section in manual.sections:
            if not section.own:
                continue
            out += ["", f"### {cell(section.heading)}"]
            out += table("number", "statement in the manual", "shown by, or reason why not")
            for item in (items[number] for number in section.own):
                out.append(f"| {item.number} | {cell(item.text)} | {describe(item)} |")
        for device in value_only.DEVICES[manual.name]:
            rows = value_only.document(source, device, problems)
            if rows:
                out += ["", f"### Objects of {device} with a value only", "", VALUE_ONLY]
                out += table("object", "name", "place in the manual", "reason") + rows
    return "\n".join(out) + "\n"


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    folder = source / "tests" / "manuals"
    problems: list[str] = []
    items: dict[str, Item] = {}
    manuals = [read_manual(folder / f"{name}.md", items, problems) for name in MANUALS]
    for manual in manuals:
        check_sections(manual, items, problems)
        compare_with_text(manual, source.parent / "shared" / "seeds", problems)
    for item, (kind, reason) in read_rows(folder / "out_of_reach.tsv", 3, items, problems):
        if item.kind:
            problems.append(f"out_of_reach.tsv: duplicate item [{item.number}]")
        if kind not in KINDS or not reason:
            problems.append(f"out_of_reach.tsv: [{item.number}] is '{kind}', because '{reason}'")
        item.kind, item.reason = kind, reason
    for item, (reading,) in read_rows(folder / "readings.tsv", 2, items, problems):
        item.reading = reading
    read_tests(source / "tests", items, problems)
    check_units(source, problems)
    problems += [f"[{item.number}] has neither a test nor a reason: {item.text}" for item in items.values()
                 if item.state == "missing"]
    page, text = source / "docs/developers/manuals.md", document(source, manuals, items, problems)
    if "--write" in sys.argv:
        page.write_text(text, encoding="utf-8")
    elif not page.exists() or page.read_text(encoding="utf-8") != text:
        problems.append("docs/developers/manuals.md is not up to date: run manuals_test.py with --write")
    print("\n".join(problems))
    for manual in [*MANUALS, ""]:
        own = [item for item in items.values() if item.number.startswith(manual)]
        states = ", ".join(f"{count(own, state)} {state}" for state in ("shown", *KINDS, "missing"))
        print(f"{manual or 'all'}: {len(own)} items: {states}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
