"""The units that the manuals print, tests/manuals/units.tsv, are those of the EDS files.

Each row is: EDS without its suffix, object (6200h, 6005h:01 or 1800h:03..05), unit, factor, place in the manual. A value times
its factor is in the unit; a factor of 1 may be missing in the EDS.
"""

from __future__ import annotations

from pathlib import Path

from value_only import OBJECT, entries_of_eds, text_of


def check_units(source: Path, problems: list[str]) -> None:
    path = source / "tests" / "manuals" / "units.tsv"
    devices: dict[str, dict] = {}
    for count, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        cells = line.split("\t")
        match = OBJECT.fullmatch(cells[1]) if len(cells) == 5 and all(cells) else None
        if match is None:
            problems.append(f"{path.name}:{count}: expected device, object, unit, factor and place")
            continue
        device, _, unit, factor, _ = cells
        entries = devices.setdefault(device, entries_of_eds(source, device))
        index, first = int(match[1], 16), int(match[2] or "0", 16)
        for sub in range(first, int(match[3] or match[2] or "0", 16) + 1):
            entry = entries.get((index, sub))
            if entry is None:
                problems.append(f"{path.name}:{count}: {device} does not have {text_of((index, sub))}")
            elif (entry.get("Unit"), entry.get("Factor", "1")) != (unit, factor):
                problems.append(f"{path.name}:{count}: the EDS has the unit {entry.get('Unit')} and the factor "
                                f"{entry.get('Factor', '1')} for {text_of((index, sub))}")
