#!/usr/bin/env python3
"""An object that only SDO and PDOs read or write has a row in value_only.tsv of its device, and no other object has.

    value_only_test.py SOURCE_DIR ACCESS_FILE...

The access files are written by GoogleTest programs (tests/support/access_probe.hpp): the objects that the applications of the
runnable nodes, their handlers and profiles have used in all tests. Missing files: skipped.
"""

from __future__ import annotations

import sys
from pathlib import Path

from value_only import DEVICES, Key, names_in_eds, read_rows, text_of


def main() -> int:
    source = Path(sys.argv[1]).resolve()
    files = [Path(name) for name in sys.argv[2:]]
    missing = [file.stem for file in files if not file.exists()]
    if missing:
        print(f"SKIPPED: run {', '.join(missing)} before")
        return 77
    used: dict[str, set[Key]] = {}
    for file in files:
        for line in file.read_text(encoding="utf-8").splitlines():
            device, index, sub = line.split("\t")
            used.setdefault(device, set()).add((int(index, 16), int(sub, 16)))
    problems: list[str] = []
    for device in (device for devices in DEVICES.values() for device in devices):
        names = names_in_eds(source, device)
        unused = {key for key in names if key not in used.get(device.replace("-", "_"), set())}
        rows = {key: row for row in read_rows(source, device, problems) for key in row.keys}
        print(f"{device}: {len(names)} entries, {len(unused)} with a value only")
        undecided = [f"{text_of(key)} {names[key]}" for key in sorted(unused) if key not in rows]
        problems += [f"{device}: {entry} is used by SDO and PDOs only: give it its function or a row in value_only.tsv"
                     for entry in undecided]
        problems += [f"{device}: {text_of(key)} is used by the application: remove its row in value_only.tsv"
                     for key in sorted(rows) if key in names and key not in unused]
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
