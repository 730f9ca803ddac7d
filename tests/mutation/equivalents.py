"""Mutants that no test can detect, each with a reason: a table of file, line, mutated line and reason."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from points import Mutation


@dataclass(frozen=True)
class Equivalent:
    file: str
    line: str
    mutated: str
    reason: str


def read_equivalents(path: Path) -> list[Equivalent]:
    with path.open(newline="") as table:
        rows = list(csv.reader(table, delimiter="\t", quoting=csv.QUOTE_NONE))
    return [Equivalent(*row) for row in rows[1:]]


def find_equivalent(mutation: Mutation, source: bytes, known: list[Equivalent]) -> Equivalent | None:
    line, mutated = mutation.changed_line(source)
    return next((row for row in known if (row.file, row.line, row.mutated) == (mutation.file, line, mutated)), None)


def stale_rows(root: Path, known: list[Equivalent]) -> list[Equivalent]:
    """Returns the rows whose line is no longer in its file."""
    def is_there(row: Equivalent) -> bool:
        path = root / row.file
        return path.is_file() and row.line in (line.strip() for line in path.read_text().splitlines())
    return [row for row in known if not is_there(row)]
