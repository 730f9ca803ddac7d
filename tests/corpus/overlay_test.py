#!/usr/bin/env python3
"""An overlay makes the edited copy of a vendor's file: `overlay from`, then `overlay apply`, for random changes of each file.

    overlay_test.py SOURCE_DIR EDSC [--files N] [--seed N]

A program changes the text of N files of the corpus: values, removed keys, added keys, removed and added entries and objects,
with and without their lists and counts. `edsc dump` of the result must be that of the edited copy; the bytes of all lines
that an edit does not touch must be those of the base. The corpus is in the folder EDSC_CORPUS, or in ../shared/eds-corpus
beside the repository; without it the test is skipped.
"""

from __future__ import annotations

import argparse
import difflib
import json
import random
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus_test import find_corpus, paths_in  # noqa: E402
from support.compilers import SKIPPED, in_parallel  # noqa: E402

SECTION = re.compile(rb"^[ \t]*\[([^\]\r\n]*)\]")
KEY = re.compile(rb"^[ \t]*([^=;#\[\s][^=\r\n]*?)[ \t]*=[ \t]*([^\r\n]*?)[ \t]*(\r\n|\r|\n|$)")
ENTRY = re.compile(rb"^([0-9A-Fa-f]{4})(sub([0-9A-Fa-f]{1,2}))?$", re.IGNORECASE)
NEW_VALUES = {b"datatype": (b"0x0005", b"0x0006", b"7"), b"accesstype": (b"rw", b"ro", b"const", b"wo"),
              b"pdomapping": (b"0", b"1"), b"defaultvalue": (b"0", b"0x12", b"$NODEID+0x180", b"17"),
              b"lowlimit": (b"0", b"-1"), b"highlimit": (b"1", b"0xFF"), b"parametername": (b"Changed", b"Other name")}


@dataclass
class Section:
    name: bytes
    header: bytes
    lines: list[bytes] = field(default_factory=list)


def split(text: bytes) -> list[Section]:
    sections = [Section(b"", b"")]
    for line in re.findall(rb"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+$", text):
        header = SECTION.match(line)
        if header:
            sections.append(Section(header[1].strip(), line))
        else:
            sections[-1].lines.append(line)
    return sections


def joined(sections: list[Section]) -> bytes:
    return b"".join(section.header + b"".join(section.lines) for section in sections)


def mutate(text: bytes, chance: random.Random) -> bytes:
    """The text after some random changes."""
    sections = split(text)
    end = b"\r\n" if b"\r\n" in text else b"\n"
    for _ in range(chance.randint(1, 12)):
        entries = [one for one in sections if ENTRY.match(one.name)]
        if not entries:
            break
        section = chance.choice(entries)
        keys = [(i, KEY.match(line)) for i, line in enumerate(section.lines) if KEY.match(line)]
        kind = chance.choice(("value", "value", "value", "remove key", "add key", "remove entry", "add entry", "list"))
        if kind == "value" and keys:
            at, key = chance.choice(keys)
            values = NEW_VALUES.get(key[1].lower())
            if values:
                section.lines[at] = key[1] + b"=" + chance.choice(values) + key[3]
        elif kind == "remove key" and keys:
            del section.lines[chance.choice(keys)[0]]
        elif kind == "add key" and keys:
            name = chance.choice((b"LowLimit", b"HighLimit", b"ObjFlags", b"Denotation"))
            if not any(key[1].lower() == name.lower() for _, key in keys) and keys[-1][1][3]:
                section.lines.insert(keys[-1][0] + 1, name + b"=1" + end)
        elif kind == "remove entry":
            index, sub = ENTRY.match(section.name)[1].lower(), ENTRY.match(section.name)[2]
            gone = [one for one in entries if one is section or not sub and one.name[:4].lower() == index]
            sections = [one for one in sections if one not in gone and (sub or one.name[:4].lower() != index)]
        elif kind == "add entry":
            add_entry(sections, section, chance, end)
        elif kind == "list":
            lists = [one for one in sections if one.name.lower().endswith(b"objects") and one.lines]
            if lists:
                one = chance.choice(lists)
                rows = [i for i, line in enumerate(one.lines) if re.match(rb"^\d+\s*=", line)]
                if rows:
                    del one.lines[chance.choice(rows)]
    return joined(sections)


def add_entry(sections: list[Section], section: Section, chance: random.Random, end: bytes) -> None:
    names = {one.name.lower() for one in sections}
    index = ENTRY.match(section.name)[1]
    name = chance.choice((b"%04X" % chance.randint(0x2000, 0x5FFF), index + b"sub%X" % chance.randint(0, 255)))
    if name.lower() in names or b"[" not in section.header or not section.lines:
        return
    lines = [b"ParameterName=Added", b"ObjectType=0x7", b"DataType=0x0007", b"AccessType=rw", b"DefaultValue=3"]
    at = next(i for i, one in enumerate(sections) if one is section) + 1
    if not section.lines[-1].endswith((b"\r", b"\n")):
        section.lines[-1] += end
    sections.insert(at, Section(name, b"[" + name + b"]" + end, [line + end for line in lines] + [end]))


def without_places(value: object) -> object:
    if isinstance(value, dict):
        return {key: without_places(one) for key, one in value.items() if key not in ("line", "file", "source")}
    if isinstance(value, list):
        return [without_places(one) for one in value]
    return value


def dump(edsc: Path, path: Path) -> object:
    result = subprocess.run([edsc, "dump", "--keep-going", path], capture_output=True, timeout=600)
    if not result.stdout:
        return f"exit code {result.returncode}"
    device = without_places(json.loads(result.stdout))
    del device["name"]  # of the file
    return device


def check(edsc: Path, path: Path, seed: int) -> tuple[str, bool]:
    """A problem, or nothing; whether the file can be dumped."""
    base = path.read_bytes()
    if base.startswith((b"\xff\xfe", b"\xfe\xff", b"\x1f\x8b")):
        return "", False
    edited = mutate(base, random.Random(f"{seed} {path.name}"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        suffix = path.suffix
        (folder / f"base{suffix}").write_bytes(base)
        copy, result = folder / f"copy{suffix}", folder / f"result{suffix}"
        copy.write_bytes(edited)
        overlay = folder / "x.overlay"
        for words in (("from", folder / f"base{suffix}", copy, "-o", overlay), ("apply", overlay, "-o", result)):
            ran = subprocess.run([edsc, "overlay", *words], capture_output=True, text=True, errors="replace", timeout=600)
            if ran.returncode != 0:
                shown = overlay.read_text(errors="replace")[-1500:] if overlay.exists() else ""
                return f"overlay {words[0]}: {ran.stderr[-1500:]}\n{shown}", False
        wanted, got, read = dump(edsc, copy), dump(edsc, result), dump(edsc, overlay)
        for title, other in (("apply", got), ("dump of the overlay", read)):
            if wanted != other:
                return f"{title}: another device\n{overlay.read_text(errors='replace')[-1500:]}", False
        touched = touched_lines(base, edited)
        written = lines_of(result.read_bytes())
        for line in lines_of(base) - written:
            got_an_end = not line.endswith((b"\r", b"\n")) and any(line + end in written for end in (b"\n", b"\r\n"))
            if not got_an_end and line not in touched and not is_derived(line):
                return f"a line was changed: {line!r}", False
        return "", not isinstance(wanted, str)


def lines_of(text: bytes) -> set[bytes]:
    return set(re.findall(rb"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+$", text))


def touched_lines(base: bytes, edited: bytes) -> set[bytes]:
    """The lines of the base that the edited copy does not have at their place, and comments, which may go with a section."""
    before, after = base.splitlines(keepends=True), edited.splitlines(keepends=True)
    matcher = difflib.SequenceMatcher(None, before, after, autojunk=False) if len(before) < 3000 else None
    if matcher is None:
        return lines_of(base) - lines_of(edited) | {line for line in before if line.lstrip()[:1] in (b";", b"#", b"")}
    gone = {line for tag, first, last, _, _ in matcher.get_opcodes() if tag != "equal" for line in before[first:last]}
    return gone | {line for line in before if line.lstrip()[:1] in (b";", b"#", b"")}


def is_derived(line: bytes) -> bool:
    """A line of an object list, SubNumber or a highest sub-index."""
    return bool(re.match(rb"^\s*(\d+|SupportedObjects|SubNumber|DefaultValue)\s*=", line, re.IGNORECASE))


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--files", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    settings = parser.parse_args()
    corpus = find_corpus(settings.source.resolve())
    if corpus is None:
        print("SKIPPED: no corpus")
        return SKIPPED
    edsc = settings.edsc.resolve()
    paths = sorted(corpus / path for path in paths_in(corpus) if settings.only in path)
    random.Random(settings.seed).shuffle(paths)
    paths = [path for path in paths if path.read_bytes()[:2] != b"\x1f\x8b" and b"\0" not in path.read_bytes()[:64]]
    paths = paths[:settings.files]
    results = in_parallel(lambda path: check(edsc, path, settings.seed), paths)
    problems = [(path, problem) for path, (problem, _) in zip(paths, results) if problem]
    for path, problem in problems:
        print(f"{path}: {problem}")
    dumped = sum(is_dumped for _, is_dumped in results)
    print(f"{len(paths)} files, {dumped} compared as devices, {len(problems)} problems")
    return 1 if problems or dumped < len(paths) // 2 else 0


if __name__ == "__main__":
    sys.exit(main())
