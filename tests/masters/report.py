"""The checks of a walk, and its known exceptions: a row of exceptions.tsv for each difference of a device from CiA 301 or its
EDS, or for each check that must not be tried."""

from __future__ import annotations

import fnmatch
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

SKIP, ANY = "skip", "any"


def fits(patterns: str, device: str) -> bool:
    return any(fnmatch.fnmatch(device, one) for one in patterns.split(","))


def read_rows(path: Path) -> list[tuple[int, list[str]]]:
    """Returns the rows of a table with their line numbers."""
    lines = enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
    return [(number, line.split("\t")) for number, line in lines if line and not line.startswith("#")]


@dataclass
class Exception_:
    device: str   # patterns of names, such as can_20*, several with commas
    entries: str  # "1010h:01", "1400h-15FFh:01", "1003h:01-10" or "6040h:*", several with commas
    checks: str   # several with commas
    outcome: str  # "skip", "any", or the actual result, such as "abort 06010002"
    reason: str
    line: int
    used: bool = False    # a walk has reached it
    needed: bool = False  # and would fail without it

    def covers(self, device: str, entry: str, check: str) -> bool:
        return (fits(self.device, device) and check in self.checks.split(",")
                and any(self.names(one, entry) for one in self.entries.split(",")))

    @staticmethod
    def names(pattern: str, entry: str) -> bool:
        if pattern == entry:
            return True
        place, match = re.fullmatch(r"([0-9A-F]{4})h:([0-9A-F]{2})", entry), re.fullmatch(
            r"([0-9A-F]{4})h(?:-([0-9A-F]{4})h)?:(?:\*|([0-9A-F]{2})(?:-([0-9A-F]{2}))?)", pattern)
        if not place or not match:
            return False
        first, last, low, high = (int(text, 16) if text else None for text in match.groups())
        in_range = first <= int(place[1], 16) <= (last or first)
        return in_range and (low is None or low <= int(place[2], 16) <= (low if high is None else high))


def read_exceptions(path: Path) -> list[Exception_]:
    return [Exception_(*columns, line=number) for number, columns in read_rows(path)]


class Report:
    """The checks of one device. Only failures are printed."""

    def __init__(self, device: str, exceptions: list[Exception_]) -> None:
        self.device, self.exceptions = device, exceptions
        self.passed: Counter[str] = Counter()
        self.failed: Counter[str] = Counter()
        self.excepted: Counter[str] = Counter()

    def exception(self, entry: str, check: str) -> Exception_ | None:
        for row in self.exceptions:
            if row.covers(self.device, entry, check):
                row.used = True
                return row
        return None

    def skips(self, entry: str, check: str) -> bool:
        row = self.exception(entry, check)
        if row is None or row.outcome != SKIP:
            return False
        row.needed = True
        self.excepted[check] += 1
        return True

    def check(self, check: str, entry: str, got: str, wanted: str) -> bool:
        """Returns whether the result is as expected, or as in an exception."""
        row = self.exception(entry, check)
        if row is not None and got != wanted:
            row.needed = True
            self.excepted[check] += row.outcome in (ANY, got)
        good = got == wanted if row is None else row.outcome in (ANY, got)
        if row is not None and row.outcome == wanted:
            good = got == wanted
        (self.passed if good else self.failed)[check] += 1
        if not good:
            expected = wanted if row is None else f"{row.outcome} (exceptions.tsv:{row.line})"
            print(f"{self.device}: {check} {entry}: {got}, wanted {expected}", flush=True)
        return good

    def summary(self) -> str:
        kinds = sorted(set(self.passed) | set(self.failed) | set(self.excepted))
        parts = [f"{kind} {self.passed[kind]}" + (f" ({self.failed[kind]} FAILED)" if self.failed[kind] else "")
                 for kind in kinds]
        return (f"{self.device}: {sum(self.passed.values())} checks ok, {sum(self.failed.values())} failed, "
                f"{sum(self.excepted.values())} by exception: {', '.join(parts)}")


def stale(exceptions: list[Exception_]) -> list[str]:
    """Returns the rows that were not needed."""
    return [f"exceptions.tsv:{row.line}: {row.device} {row.entries} {row.checks}: " +
            ("no device differs here any more" if row.used else "the entry does not exist") for row in exceptions
            if not row.needed]
