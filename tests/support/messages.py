"""The messages of a compiler, for each of the cases of one translation unit."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from support.compilers import Compiler, compile_only
from support.debian import is_debian

# The lines that the messages of a mistake may have. Later compilers than those of Debian 12 show the source of each place.
MOST_LINES = 12 if is_debian(12) else 18

# Lines before the line of a message: where it is, and how the compiler came there.
BEFORE_A_MESSAGE = re.compile(r"^In file included from |^ +from \S+:\d+|^\S+: (In|At) |"
                              r"^\S+:\d+:(\d+:)?  +(required|recursively required|in .constexpr. expansion)")
ERROR = re.compile(r"^\S+?:\d+:(\d+:)? (fatal )?error: |^\S+?:\d+:(\d+:)? warning: ")
# A line with a place: a file, or a line of it.
PLACED = re.compile(r"^(?P<place>(?P<file>\S+?):(\d+:(\d+:)?)?) (?P<rest>.*)")
INCLUDED = re.compile(r"^In file included from |^ +from \S+:\d+")
SUMMARY = re.compile(r"^\d+ (error|warning)s?.* generated\.$|^cc1plus: (all|some) warnings being treated as errors$")


def without_lists(output: str) -> list[str]:
    """Returns the lines of the messages, without the lists of including files and without a summary."""
    return [line for line in output.splitlines() if not INCLUDED.match(line) and not SUMMARY.match(line)]


def errors_in(output: str) -> list[list[str]]:
    """Returns the lines of each error, with its notes and excerpts of sources. A summary of all errors is ignored."""
    errors: list[list[str]] = []
    before: list[str] = []
    for line in output.splitlines():
        if SUMMARY.match(line):
            continue
        if BEFORE_A_MESSAGE.match(line):
            before.append(line)
            continue
        if ERROR.match(line) or not errors:
            errors.append([])
        errors[-1] += [*before, line]
        before = []
    return errors


@dataclass
class Printed:
    """What a compiler prints once for several errors, and would print for each of them alone."""
    compiler: Compiler
    lists: dict[str, list[str]] = field(default_factory=dict)     # of the files that include a file
    excerpts: dict[str, list[str]] = field(default_factory=dict)  # of the source, by the place of an error

    def add(self, error: list[str]) -> None:
        listed: list[str] = []
        for number, line in enumerate(error):
            if INCLUDED.match(line):
                listed.append(line)
            elif placed := PLACED.match(line):
                if listed:
                    self.lists.setdefault(placed["file"], listed)
                listed = []
                if ERROR.match(line) and error[number + 1:] and error[number + 1].startswith(" "):
                    self.excerpts.setdefault(placed["place"], error[number + 1:number + 3])

    def complete(self, error: list[str]) -> list[str]:
        lines: list[str] = []
        for line in error:
            placed = PLACED.match(line)
            if placed and not (self.compiler.is_clang and placed["rest"].startswith("note: ")):  # Clang: no list
                lines += [including for including in self.lists.get(placed["file"], []) if including not in error + lines]
            lines.append(line)
            if placed and ERROR.match(line):
                lines += [quoted for quoted in self.excerpts.get(placed["place"], []) if quoted not in error]
        return lines


def messages_of_cases(compiler: Compiler, cases: Sequence[tuple[str, str]], folder: Path, include: Sequence[Path],
                      flags: Iterable[str]) -> dict[str, list[str]]:
    """Compiles the texts of the cases as one file; returns the lines of the messages of each name, and those of none for "".

    A specialization of a template reports its error once: cases that use the same one belong into different calls. If a message
    names the file of no case, as some of g++ 14 do, each case is compiled alone.
    """
    folder.mkdir()
    unit = ""
    for number, (_, text) in enumerate(cases):
        source = folder / f"case_{number}.cpp"
        source.write_text(text)  # the compiler quotes it
        unit += f'#line 1 "{source}"\n{text}'
    (folder / "unit.cpp").write_text(unit)
    no_limit = ("-ferror-limit=0",) if compiler.is_clang else ()
    run = compile_only(compiler, folder / "unit.cpp", include, (*no_limit, *flags))
    messages: dict[str, list[str]] = {"": [], **{name: [] for name, _ in cases}}
    errors, printed = errors_in(run.stderr), Printed(compiler)
    for error in errors:
        printed.add(error)
    for error in errors:
        place = re.search(rf"{re.escape(str(folder))}/case_(\d+)\.cpp", "\n".join(error))
        name = cases[int(place[1])][0] if place else cases[0][0] if len(cases) == 1 else ""
        messages[name] += printed.complete(error)
    if messages[""] and len(cases) > 1:
        alone = [messages_of_cases(compiler, [case], folder / f"alone_{number}", include, flags)
                 for number, case in enumerate(cases)]
        return {"": [line for each in alone for line in each[""]], **{name: each[name] for each in alone for name in each if name}}
    if (run.returncode == 0) != (run.stderr == ""):
        messages[""].append(f"{compiler.name} returned {run.returncode}")
    return messages
