#!/usr/bin/env python3
"""The EDS of the EZD-1136 has the units that manual 001 prints, and the version that it names.

    manual_001_eds_test.py SOURCE_DIR

The tables are typed from the manual. A unit with a number, such as 0.01 RPS, is Unit and Factor. 6082h and 609Ah have a unit
in the mode table only, which prints P/S and P/S^2 for all speeds and accelerations.
"""

from __future__ import annotations

import configparser
import sys
from pathlib import Path

CONFIGURATION_PARAMETERS = {
    "2064": "0.001 A", "2065": "0.01 V", "2090": "0.001 V", "20D5": "%", "20F1": "0.001 A", "20F2": "PPR", "20F5": "ms",
}
MOTION_PARAMETERS = {
    "6064": "pulse", "606C": "0.01 RPS", "607A": "pulse", "607C": "pulse", "607Dsub1": "pulse", "607Dsub2": "pulse",
    "6081": "0.01 RPS", "6082": "0.01 RPS", "6083": "RPS^2", "6084": "RPS^2", "6085": "RPS^2", "6099sub1": "0.01 RPS",
    "6099sub2": "0.01 RPS",
    "609A": "RPS^2", "60FF": "0.01 RPS",
}
CHAPTERS = {"100C": "ms", "1017": "ms", "1800sub3": "100 us", "1801sub3": "100 us", "1802sub3": "100 us",
            "1803sub3": "100 us"}


def unit_of(section: configparser.SectionProxy) -> str:
    factor = section.get("Factor", "")
    return f"{factor} {section.get('Unit', '')}".strip()


def differences(eds: configparser.ConfigParser, expected: dict[str, str]) -> list[str]:
    return [f"[{name}]: expected unit {unit}, got {unit_of(eds[name]) or 'none'}" for name, unit in expected.items()
            if unit_of(eds[name]) != unit]


# shows 001.34, 001.95, 001.226
def test_configuration_parameters(eds: configparser.ConfigParser) -> list[str]:
    return differences(eds, CONFIGURATION_PARAMETERS) + differences(eds, CHAPTERS)


# shows 001.99, 001.222, 001.227
def test_motion_parameters(eds: configparser.ConfigParser) -> list[str]:
    return differences(eds, MOTION_PARAMETERS)


def test_no_other_units(eds: configparser.ConfigParser) -> list[str]:
    known = {**CONFIGURATION_PARAMETERS, **MOTION_PARAMETERS, **CHAPTERS}
    return [f"[{name}]: the manual does not print a unit" for name in eds.sections()
            if unit_of(eds[name]) and name not in known]


# shows 001.210
def test_version(eds: configparser.ConfigParser) -> list[str]:
    version = eds["FileInfo"]["EDSVersion"]
    return [] if version == "4.0" else [f"EDSVersion is {version}"]


def main() -> int:
    eds = configparser.ConfigParser(interpolation=None, comment_prefixes=(";",))
    eds.optionxform = str  # type: ignore[assignment,method-assign]
    eds.read(Path(sys.argv[1]) / "eds" / "ezd-1136.eds", encoding="utf-8")
    tests = [value for name, value in globals().items() if name.startswith("test_")]
    problems = [f"{test.__name__}: {problem}" for test in tests for problem in test(eds)]
    print("\n".join(problems) if problems else f"{len(tests)} tests passed")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
