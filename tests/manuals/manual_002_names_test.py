#!/usr/bin/env python3
"""What manual 002 prints about the objects of the CPD and no frame carries: object codes, units, internal names.

    manual_002_names_test.py SOURCE_DIR EDSC      compares the tables of the manual with the output of `edsc dump`
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

OBJECTS = (  # 9.2: index, object code, data type (of a VAR or an ARRAY), access; where 9.4 differs: 9.4
    (0x1000, "VAR", "UNSIGNED32", "ro"),
    (0x1001, "VAR", "UNSIGNED8", "ro"),
    (0x1003, "ARRAY", "UNSIGNED32", "rw"),
    (0x1005, "VAR", "UNSIGNED32", "rw"),
    (0x1008, "VAR", "VISIBLE", "ro"),
    (0x1009, "VAR", "VISIBLE", "ro"),
    (0x100A, "VAR", "VISIBLE", "ro"),
    (0x100C, "VAR", "UNSIGNED16", "rw"),
    (0x100D, "VAR", "UNSIGNED8", "rw"),
    (0x1010, "ARRAY", "UNSIGNED32", "rw"),
    (0x1011, "ARRAY", "UNSIGNED32", "rw"),
    (0x1014, "VAR", "UNSIGNED32", "rw"),
    (0x1015, "VAR", "UNSIGNED16", "rw"),
    (0x1016, "ARRAY", "UNSIGNED32", "rw"),
    (0x1017, "VAR", "UNSIGNED16", "rw"),
    (0x1018, "RECORD", "", "ro"),
    (0x1020, "ARRAY", "UNSIGNED32", "rw"),
    (0x1029, "ARRAY", "UNSIGNED8", "rw"),  # 9.4.18
    (0x1200, "RECORD", "", "ro"),
    (0x1201, "RECORD", "", "rw"),
    (0x1400, "RECORD", "", "rw"),
    (0x1401, "RECORD", "", "rw"),
    (0x1402, "RECORD", "", "rw"),
    (0x1403, "RECORD", "", "ro"),
    (0x1600, "RECORD", "", "rw"),
    (0x1601, "RECORD", "", "rw"),
    (0x1602, "RECORD", "", "rw"),
    (0x1603, "RECORD", "", "ro"),
    (0x1800, "RECORD", "", "rw"),
    (0x1801, "RECORD", "", "rw"),
    (0x1802, "RECORD", "", "rw"),
    (0x1803, "RECORD", "", "ro"),
    (0x1A00, "RECORD", "", "rw"),
    (0x1A01, "RECORD", "", "rw"),
    (0x1A02, "RECORD", "", "rw"),
    (0x1A03, "RECORD", "", "rw"),
)
# Differences, which `Contradictions and misprints` of 002.md decides: entries that are read-only by 9.4 or as constants.
READ_ONLY = {0x1600, 0x1601, 0x1602, 0x1A00, 0x1A01, 0x1A02}
WRITABLE = {0x1403, 0x1603, 0x1803}

INTERNAL_NAMES = (  # 9.3
    (0x603F, 0, "_StopFault"),
    (0x6040, 0, "DCOMcontrol"),
    (0x6041, 0, "DCOMstatus"),
    (0x6060, 0, "DCOMopmode"),
    (0x6061, 0, "_DCOMopmd_act"),
    (0x6064, 0, "_p_actusr"),
    (0x6065, 0, "SPV_p_maxDiff"),
    (0x6067, 0, "STANDp_win"),
    (0x6068, 0, "STANDpwinTime"),
    (0x606B, 0, "_n_actRAMP"),
    (0x606C, 0, "_n_act"),
    (0x607A, 0, "PPp_targetusr"),
    (0x607D, 1, "SPVswLimNusr"),
    (0x607D, 2, "SPVswLimPusr"),
    (0x607F, 0, "RAMPn_max"),
    (0x6081, 0, "PPn_target"),
    (0x6083, 0, "RAMPacc"),
    (0x6084, 0, "RAMPdecel"),
    (0x6086, 0, "ProfileType"),
    (0x6098, 0, "HMmethod"),
    (0x6099, 1, "HMn"),
    (0x6099, 2, "HMn_out"),
    (0x60F4, 0, "_p_dif"),
    (0x60FF, 0, "PVn_target"),
    (0x6502, 0, "SuppDriveModes"),
)
NAMES_IN_THE_TEXT = (  # 3.3.4, 3.5.1, chapter 6
    (0x3004, 1, "PAReeprSave"), (0x3004, 8, "PARusrReset"), (0x3006, 0x0F, "IOsigLimN"), (0x3006, 0x12, "POSdirOfRotat"),
    (0x3008, 1, "_IO_act"), (0x3009, 1, "ANA1_act"), (0x3009, 5, "ANA2_act"), (0x3011, 5, "LIM_I_maxQSTP"),
    (0x3011, 6, "LIM_I_maxHalt"), (0x301B, 9, "JOGactivate"), (0x301C, 4, "_actionStatus"), (0x301C, 7, "_SigActive"),
    (0x301C, 8, "_SigLatched"), (0x301C, 0x0B, "_WarnActive"), (0x301C, 0x0C, "_WarnLatched"), (0x301F, 2, "_p_actRAMPusr"),
    (0x3020, 4, "CUR_I_target"), (0x3021, 4, "SPEEDn_target"), (0x3026, 3, "GEARdenom"), (0x3026, 4, "GEARnum"),
    (0x303B, 5, "FLT_MemReset"), (0x303C, 1, "FLT_err_num"), (0x2041, 0, "driveStat"),
)
UNITS = (  # index, sub-index, unit, factor as the manual prints them
    (0x100C, 0, "ms", ""), (0x1015, 0, "us", "100"), (0x1017, 0, "ms", ""),
    (0x1800, 3, "us", "100"), (0x1800, 5, "ms", ""), (0x1801, 3, "us", "100"), (0x1801, 5, "ms", ""),
    (0x1802, 3, "us", "100"), (0x1802, 5, "ms", ""), (0x1803, 3, "us", "100"), (0x1803, 5, "ms", ""),
    (0x3009, 1, "mV", ""), (0x3009, 5, "mV", ""), (0x3011, 5, "A", "0.01"), (0x3011, 6, "A", "0.01"),
    (0x3020, 4, "A", "0.01"), (0x3021, 4, "rpm", ""), (0x3029, 4, "rpm", ""), (0x3029, 5, "rpm", ""),
    (0x6065, 0, "Inc", ""), (0x6068, 0, "ms", ""), (0x606C, 0, "rpm", ""), (0x607F, 0, "rpm", ""), (0x6081, 0, "rpm", ""),
    (0x6083, 0, "rpm/s", ""), (0x6084, 0, "rpm/s", ""), (0x6099, 1, "rpm", ""), (0x6099, 2, "rpm", ""),
    (0x60FF, 0, "rpm", ""),
)

problems: list[str] = []


def expect_equal(found: Any, expected: Any, place: str) -> None:
    if found != expected:
        problems.append(f"{place}: expected {expected!r}, got {found!r}")


# shows 002.322, 002.327..002.361, 002.387, 002.390, 002.393, 002.398, 002.402, 002.404, 002.406, 002.408, 002.410
# shows 002.412, 002.417, 002.422, 002.424, 002.426, 002.431, 002.433, 002.439, 002.443, 002.446, 002.450, 002.455
# shows 002.461, 002.466, 002.471, 002.475, 002.478, 002.485, 002.492, 002.495, 002.502, 002.509, 002.516, 002.523
# shows 002.527, 002.533, 002.540
def check_objects(objects: dict[int, Any]) -> None:
    for index, code, data_type, access in OBJECTS:
        place = f"{index:04X}h"
        item = objects[index]
        expect_equal(item["object_type"], code, place)
        value = item["entries"][0 if code == "VAR" else 1]
        if data_type:
            expect_equal(value["data_type"].replace("_STRING", ""), data_type, place)
        if index in READ_ONLY:
            access = "ro"
        if index in WRITABLE:
            access = "rw"
        expect_equal(any(entry["access"] != "ro" for entry in item["entries"]), access == "rw", place + ", writable")


# shows 002.362..002.386
def check_names(entries: dict[tuple[int, int], Any]) -> None:
    for index, sub_index, name in INTERNAL_NAMES + NAMES_IN_THE_TEXT:
        expect_equal(entries[index, sub_index].get("description", ""), name, f"{index:04X}h:{sub_index:02X}")


# shows 002.268, 002.280, 002.288, 002.289, 002.293, 002.304, 002.310, 002.311, 002.409, 002.425, 002.432, 002.550
def check_units(entries: dict[tuple[int, int], Any]) -> None:
    for index, sub_index, unit, factor in UNITS:
        entry = entries[index, sub_index]
        place = f"{index:04X}h:{sub_index:02X}"
        expect_equal(entry.get("unit", ""), unit, place)
        expect_equal(str(entry.get("factor", "")), factor, place)


def main() -> int:
    source, edsc = (Path(argument).resolve() for argument in sys.argv[1:3])
    dump = subprocess.run([edsc, "dump", source / "eds/cpd.eds"], capture_output=True, text=True, check=True).stdout
    objects = {item["index"]: item for item in json.loads(dump)["objects"]}
    entries = {(entry["index"], entry["sub_index"]): entry for item in objects.values() for entry in item["entries"]}
    check_objects(objects)
    check_names(entries)
    check_units(entries)
    print("\n".join(problems) or "the names, object codes and units are those of manual 002")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
