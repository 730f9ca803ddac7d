#!/usr/bin/env python3
"""The headings of a manual, from its table of contents and its text, and their comparison with the sections of NNN.md.

    headings.py TEXT      prints the headings of a manual as the sections of NNN.md

A heading is compared without markup, dots, page number and case. Its number is compared where both sides have one.
"""

from __future__ import annotations

import html
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

PAGE_MARK = re.compile(r"<\|[^|]*\|>")
TAG = re.compile(r"</?[a-z]+>")
MARKUP = re.compile(r"^[#*\s\-•▪●]+|\*+|\\")
LEADER = re.compile(r"[\s.]*(?:\.{3,}|\t+(?:page\t+)?)[\s.]*\d+$|\.{3,}$")
NUMBER = re.compile(r"(\d+(?:\.\d+)*)\.?\s+(?=\S)")
CONTENTS_LINE = re.compile(r".*\.{5}.*\d|\d+(?:\.\d+)*\t[A-Z][^\t]+(?:\tpage)?\t+\d+")
HASH_HEADING = re.compile(r"#+ .+")
BOLD_BULLET = re.compile(r"[-•●] \*\*[^*]+\*\*")
NUMBERED = re.compile(r"(?:\d+(?:\.\d+)+|\d+\.?(?= +[A-Z])) +[A-Za-z0-9].*")
OBJECT = re.compile(r"[0-9A-F]{4}h – .+")
MAX_LENGTH = 80  # of a numbered heading; longer lines are text


@dataclass(frozen=True)
class Heading:
    number: str
    text: str  # normalised
    line: str  # as printed, without markup

    def is_same(self, other: Heading) -> bool:
        return self.text == other.text and (not self.number or not other.number or self.number == other.number)


def heading_of(line: str) -> Heading:
    plain = html.unescape(TAG.sub("", PAGE_MARK.sub("", line)))
    plain = MARKUP.sub("", LEADER.sub("", plain.strip())).strip()
    match = NUMBER.match(plain)
    text = plain[match.end():] if match else plain
    return Heading(match[1] if match else "", re.sub(r"[\W_]+", " ", text.lower()).strip(), plain.replace("\t", " "))


def is_caption(plain: str) -> bool:
    """The title of a figure, table or note, which has a `#` like a heading."""
    return plain.startswith("<") or plain.endswith(":")


def headings_of(text: str) -> list[Heading]:
    """The headings that need a section, in the order of the text; then what only the table of contents has."""
    lines = [PAGE_MARK.sub("", line) for line in text.splitlines()]
    contents = [heading_of(line) for line in lines if CONTENTS_LINE.fullmatch(TAG.sub("", line))]
    has_hashes = any(HASH_HEADING.fullmatch(line) for line in lines)
    found: list[Heading] = []
    last: tuple[int, ...] = (0,)
    joined = False
    hashes = [at for at, line in enumerate(lines) if HASH_HEADING.fullmatch(line)]
    following = dict(zip(hashes, hashes[1:]))
    for at, line in enumerate(lines):
        if HASH_HEADING.fullmatch(line):
            if joined:
                joined = False
                continue
            if is_caption(MARKUP.sub("", line).strip()):
                continue
            heading = heading_of(line)
            if at in following:  # a heading of two lines, which the table of contents has as one
                both = heading_of(line + " " + MARKUP.sub("", lines[following[at]]))
                if any(both.is_same(other) for other in contents):
                    heading, joined = both, True
            found.append(heading)
        elif has_hashes:
            if BOLD_BULLET.fullmatch(line.strip()) and not is_caption(MARKUP.sub("", line).strip()):
                found.append(heading_of(line))
        elif NUMBERED.fullmatch(line) and len(line) <= MAX_LENGTH:
            number = tuple(int(part) for part in re.match(r"[\d.]+", line)[0].strip(".").split("."))
            heading = heading_of(line)
            is_next = number > last and number[0] <= last[0] + 1 and (number[0] == last[0] or len(number) == 1)
            if is_next and (not contents or any(heading.is_same(other) for other in contents)):
                found.append(heading)
                last = number
        elif OBJECT.fullmatch(line):
            found.append(heading_of(line))
    result: list[Heading] = []
    for heading in [*found, *contents]:
        if not any(heading.is_same(other) for other in result):
            result.append(heading)
    return result


def compare_with_text(manual: Any, folder: Path, problems: list[str]) -> None:
    """Reports headings without a section, and sections whose heading is not a line of the manual."""
    texts = sorted(folder.glob(f"{manual.name}_*.txt"))
    if not texts:
        print(f"{manual.name}: SKIPPED: the text of the manual is missing: its headings are not compared with the sections")
        return
    text = texts[0].read_text(encoding="utf-8")
    required = headings_of(text)
    sections = [heading_of(section.heading) for section in manual.sections[:-1]]
    problems += [f"{manual.name}.md: missing section: {heading.line}" for heading in required
                 if not any(heading.is_same(section) for section in sections)]
    lines = [heading_of(line) for line in text.splitlines() if len(line) < 200]
    known = {(heading.text) for heading in [*required, *lines]}
    problems += [f"{manual.name}.md: the manual does not have the section: {section.line}" for section in sections
                 if section.text not in known]


if __name__ == "__main__":
    for heading in headings_of(Path(sys.argv[1]).read_text(encoding="utf-8")):
        print(f"## {heading.line}\n")
