"""Writes mutations into one source; an environment variable selects the active one at run time."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

from pathlib import Path

from points import CONDITION, EXPRESSION, FORMS, RETURN, STATEMENT, Mutation


HEADER = Path(__file__).resolve().parent / "mutant.hpp"


@dataclass
class Point:
    """The mutations of one place and form, and the points inside it."""

    start: int
    end: int
    form: str
    mutants: list[tuple[int, Mutation]]
    inner: list[Point] = field(default_factory=list)


@dataclass
class Schemata:
    """A source with its mutations, and their positions."""

    text: bytes = b""
    places: list[tuple[int, int, tuple[int, ...]]] = field(default_factory=list)  # bytes [start, end): numbers

    def numbers_at(self, line: int, column: int) -> set[int]:
        """Returns the mutants of the innermost point there, otherwise all of the line."""
        lines = self.text.split(b"\n")
        if line > len(lines):
            return set()
        line_start = sum(len(text) + 1 for text in lines[: line - 1])
        offset = line_start + column - 1
        around = [place for place in self.places if place[0] <= offset < place[1]]
        if around:
            return set(min(around, key=lambda place: place[1] - place[0])[2])
        line_end = line_start + len(lines[line - 1])
        return {number for start, end, numbers in self.places if start <= line_end and end >= line_start
                for number in numbers}


def one_line(text: bytes) -> bytes:
    """Joins the lines of a mutated expression, so that the copy has the same lines as the original."""
    return b" ".join(part.strip() for part in text.split(b"\n"))


def nest(mutants: dict[int, Mutation]) -> list[Point]:
    """Nests points inside others. A point that overlaps another one without being inside it is omitted."""
    groups: dict[tuple[int, int, str], list[tuple[int, Mutation]]] = defaultdict(list)
    for number, mutation in sorted(mutants.items()):
        groups[mutation.start, mutation.end, mutation.form].append((number, mutation))
    points = [Point(*key, mutants) for key, mutants in groups.items()]
    points.sort(key=lambda point: (point.start, -point.end, FORMS.index(point.form)))
    outermost: list[Point] = []
    around: list[Point] = []
    for point in points:
        while around and around[-1].end <= point.start:
            around.pop()
        if around and point.end > around[-1].end:
            continue
        (around[-1].inner if around else outermost).append(point)
        around.append(point)
    return outermost


class Writer:
    def __init__(self, source: bytes, mutants: dict[int, Mutation]):
        self.source = source
        self.result = Schemata(f'#include "{HEADER}"\n'.encode())
        # Keywords of constexpr variables that are initialized at run time.
        self.keywords = {mutation.constexpr_at: mutation.constexpr_becomes for mutation in mutants.values()
                         if mutation.constexpr_at is not None}
        self.keyword_numbers = defaultdict(list)
        for number, mutation in mutants.items():
            self.keyword_numbers[mutation.constexpr_at].append(number)
        self.write(0, len(source), nest(mutants))

    def put(self, text: bytes) -> None:
        self.result.text += text

    def copy(self, start: int, end: int) -> None:
        for at in sorted(at for at in self.keywords if start <= at < end):
            self.put(self.source[start:at])
            place = len(self.result.text)
            # Compiler messages refer to the variable, so that its whole line belongs to the mutants.
            line_length = self.source[at:].find(b"\n")
            self.result.places.append((place, place + line_length, tuple(self.keyword_numbers[at])))
            self.put(self.keywords[at])
            start = at + len(b"constexpr")
        self.put(self.source[start:end])

    def write(self, start: int, end: int, points: list[Point]) -> None:
        for point in points:
            self.copy(start, point.start)
            self.write_point(point)
            start = point.end
        self.copy(start, end)

    def write_point(self, point: Point) -> None:
        place = len(self.result.text)
        if point.form == RETURN:
            self.put(f"if ({self.call(point.mutants[0])}) return {{}}; else ".encode())
            self.write(point.start, point.end, point.inner)
        elif point.form == STATEMENT:
            self.put(f"({self.call(point.mutants[0])} ? static_cast<void>(0) : static_cast<void>(".encode())
            self.write(point.start, point.end, point.inner)
            self.put(b"))")
        elif point.form == CONDITION:
            self.put(f"({self.call(point.mutants[0])} != static_cast<bool>(".encode())
            self.write(point.start, point.end, point.inner)
            self.put(b"))")
        elif point.form == EXPRESSION:
            self.put(b"(")
            for mutant in point.mutants:
                self.put(f"{self.call(mutant)} ? (".encode() + one_line(mutant[1].text) + b") : ")
            self.put(b"(")
            self.write(point.start, point.end, point.inner)
            self.put(b"))")
        numbers = tuple(number for number, _ in point.mutants)
        self.result.places.append((place, len(self.result.text), numbers))

    @staticmethod
    def call(mutant: tuple[int, Mutation]) -> str:
        number, mutation = mutant
        return f"{'edsc_mutant' if mutation.constexpr_at is None else 'edsc_table_mutant'}({number})"


def write_schemata(source: bytes, mutants: dict[int, Mutation]) -> Schemata:
    return Writer(source, mutants).result
