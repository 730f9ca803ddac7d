#!/usr/bin/env python3
"""The EDS of the EZD-1136 has the units that manual 001 prints and no others, and the version that the manual names.

    manual_001_eds_test.py SOURCE_DIR

The units are the rows of units.tsv, typed from the manual. A unit with a number, such as 0.01 RPS, is Unit and Factor.
"""

from __future__ import annotations

import configparser
import sys
from pathlib import Path

from units import check_units
from value_only import entries_of_eds

DEVICE = "ezd-1136"


def rows_of_device(source: Path) -> list[str]:
    rows = (source / "tests" / "manuals" / "units.tsv").read_text(encoding="utf-8").splitlines()
    return [row.split("\t")[1][:4] for row in rows if row.startswith(f"{DEVICE}\t")]


# shows 001.34, 001.95, 001.99, 001.222, 001.226, 001.227
def test_units(source: Path) -> list[str]:
    problems: list[str] = []
    check_units(source, problems)
    return problems


def test_no_other_units(source: Path) -> list[str]:
    known = {int(index, 16) for index in rows_of_device(source)}
    return [f"{index:04X}h: the manual does not print a unit" for (index, _), entry in entries_of_eds(source, DEVICE).items()
            if "Unit" in entry and index not in known]


# shows 001.210
def test_version(source: Path) -> list[str]:
    eds = configparser.ConfigParser(interpolation=None, comment_prefixes=(";",))
    eds.read(source / "eds" / f"{DEVICE}.eds", encoding="utf-8")
    version = eds["FileInfo"]["EDSVersion"]
    return [] if version == "4.0" else [f"EDSVersion is {version}"]


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    tests = (test_units, test_no_other_units, test_version)
    problems = [f"{test.__name__}: {problem}" for test in tests for problem in test(source)]
    print("\n".join(problems) if problems else f"{len(tests)} tests passed")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
