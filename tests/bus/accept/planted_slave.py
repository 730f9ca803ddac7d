#!/usr/bin/env python3
"""A CANopen slave without edsc's code, and an EDS that differs from it in each way that `edsc accept` distinguishes.

    planted_slave.py ADDRESS NODE_ID [good]

With `good` it is the slave of the EDS without differences.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "masters"))
from foreign_slaves_test import Bus  # noqa: E402
from slaves import NO_OBJECT, Slave  # noqa: E402

NO_SUB_INDEX, WRITE_ONLY, GENERAL = 0x06090011, 0x06010001, 0x08000000
SILENT = -1  # no response instead of an abort code
U8, U16, U32, TEXT = 0x5, 0x6, 0x7, 0x9

Entry = tuple[int, int]


def number(value: int, size: int) -> bytes:
    return value.to_bytes(size, "little")


def var(section: str, data_type: int, access: str = "rw", default: str | None = None, more: str = "") -> str:
    value = "" if default is None else f"DefaultValue={default}\n"
    return (f"\n[{section}]\nParameterName=Entry {section}\nObjectType=0x7\nDataType=0x{data_type:04X}\nAccessType={access}\n"
            f"{value}PDOMapping=0\n{more}")


def group(section: str, object_type: int, sub_number: int, count: str) -> str:
    return (f"\n[{section}]\nParameterName=Object {section}\nObjectType=0x{object_type:X}\nSubNumber={sub_number}\n"
            + var(f"{section}sub0", U8, "ro", count))


@dataclass
class Planted:
    """An object of the EDS, the values of the slave, and the difference that is expected."""
    index: int
    eds: str
    values: dict[Entry, bytes | int] = field(default_factory=dict)  # a number is an abort code
    expected: tuple[str, ...] = ()  # ENTRY KIND MARK EVIDENCE
    corrections: dict[str, tuple[str | None, str]] = field(default_factory=dict)  # "SECTION KEY": old, new
    is_listed: bool = True


ARRAY, RECORD = 8, 9

GOOD = [
    Planted(0x1000, var("1000", U32, "ro", "0"), {(0x1000, 0): bytes(4)}),
    Planted(0x1001, var("1001", U8, "ro"), {(0x1001, 0): bytes(1)}),
    Planted(0x1017, var("1017", U16, "rw", "0"), {(0x1017, 0): bytes(2)}),
    Planted(0x1018, group("1018", RECORD, 3, "2") + var("1018sub1", U32, "ro", "0x1234") + var("1018sub2", U32, "ro", "0x42"),
            {(0x1018, 0): number(2, 1), (0x1018, 1): number(0x1234, 4), (0x1018, 2): number(0x42, 4)}),
]

PLANTED = [
    Planted(0x1000, var("1000", U32, "ro", "0"), {(0x1000, 0): bytes(4)}),
    # CiA 301, 7.5.2.2: 1001h is mandatory.
    Planted(0x1001, var("1001", U8, "ro"), {}, ("1001h:00 object_missing device_wrong mandatory-object",)),
    # 7.5.2.21: 1018h has the sub-indices 0 to 4, sub-index 1 is mandatory. ProductNumber of [DeviceInfo] is 0x42.
    Planted(0x1018, group("1018", RECORD, 3, "5") + var("1018sub2", U32, "ro", "0x41") + var("1018sub5", U32, "ro"),
            {(0x1018, 0): number(5, 1), (0x1018, 1): number(0x1234, 4), (0x1018, 2): number(0x42, 4), (0x1018, 3): number(1, 4),
             (0x1018, 5): number(0, 4)},
            ("1018h:01 not_in_eds eds_wrong required-entry", "1018h:02 value eds_wrong device-info",
             "1018h:03 not_in_eds undecided additional-entry"),
            {"1018sub2 DefaultValue": ("0x41", "0x00000042"), "1018sub1 DataType": (None, "0x0007")}),
    # 7.5.2.19: sub-index 1 of 1016h is mandatory.
    Planted(0x1016, group("1016", ARRAY, 2, "1") + var("1016sub1", U32, "rw", "0"), {(0x1016, 0): number(1, 1)},
            ("1016h:01 sub_index_missing device_wrong required-sub-index",)),
    # 7.5.2.20: 1017h is UNSIGNED16 and can be read.
    Planted(0x1017, var("1017", U16, "rw", "0"), {(0x1017, 0): WRITE_ONLY}, ("1017h:00 access device_wrong standard-access",)),
    # 7.5.2.5, 7.5.2.22: 1019h is 0 or 2 to 240.
    Planted(0x1005, var("1005", U32, "rw", "0x80"), {(0x1005, 0): number(0x80, 4)}),
    Planted(0x1019, var("1019", U8, "rw", "0", "HighLimit=240\n"), {(0x1019, 0): number(250, 1)},
            ("1019h:00 limit device_wrong reserved-value",)),
    # 7.5.2.15: 1012h can be read.
    Planted(0x1012, var("1012", U32, "wo", "0x100"), {(0x1012, 0): number(0x100, 4)}, ("1012h:00 access eds_wrong eds-access",),
            {"1012 AccessType": ("wo", "rw")}),
    # 7.5.2.11, 7.5.2.12: 100Ch is UNSIGNED16, 100Dh UNSIGNED8.
    Planted(0x100C, var("100C", U16, "rw", "0"), {(0x100C, 0): bytes(4)}, ("100Ch:00 length device_wrong standard-type",)),
    Planted(0x100D, var("100D", U16, "rw", "0"), {(0x100D, 0): bytes(1)}, ("100Dh:00 length eds_wrong eds-type",),
            {"100D DataType": ("0x0006", "0x0005")}),
    # 7.5.2.33: the COB-IDs of the default SDO are those of the pre-defined connection set.
    Planted(0x1200, group("1200", RECORD, 3, "2") + var("1200sub1", U32, "ro", "$NODEID+0x600")
            + var("1200sub2", U32, "ro", "0x581"),
            {(0x1200, 0): number(2, 1), (0x1200, 1): number(0x60F, 4), (0x1200, 2): number(0x585, 4)},
            ("1200h:01 value device_wrong predefined-cob-id", "1200h:02 value eds_wrong eds-cob-id"),
            {"1200sub2 DefaultValue": ("0x581", "$NODEID+0x580")}),
    Planted(0x2000, var("2000", U16), {(0x2000, 0): bytes(4)}, ("2000h:00 length undecided free-type",),
            {"2000 DataType": ("0x0006", "0x0007")}),
    Planted(0x2001, var("2001", U16), {(0x2001, 0): WRITE_ONLY}, ("2001h:00 access undecided free-access",),
            {"2001 AccessType": ("rw", "wo")}),
    Planted(0x2002, var("2002", TEXT, "const", "V1"), {(0x2002, 0): b"V2"}, ("2002h:00 value undecided constant",),
            {"2002 DefaultValue": ("V1", "V2")}),
    Planted(0x2003, var("2003", U8, "rw", "12", "HighLimit=10\n"), {(0x2003, 0): number(12, 1)},
            ("2003h:00 limit eds_wrong eds-default",), {"2003 HighLimit": ("10", "12")}),
    Planted(0x2004, var("2004", U8, "rw", None, "LowLimit=5\n"), {(0x2004, 0): number(4, 1)},
            ("2004h:00 limit undecided free-limit",), {"2004 LowLimit": ("5", "0x04")}),
    Planted(0x2005, var("2005", U8), {}, ("2005h:00 object_missing eds_wrong object-not-listed",), {"2005 Remove": (None, "1")},
            is_listed=False),
    Planted(0x2006, var("2006", U8), {}, ("2006h:00 object_missing undecided optional-object",), {"2006 Remove": (None, "1")}),
    Planted(0x2007, var("2007", U8), {(0x2007, 0): GENERAL}, ("2007h:00 unreadable undecided abort-without-cause",)),
    Planted(0x2008, var("2008", U8), {(0x2008, 0): SILENT}, ("2008h:00 no_response undecided no-response",)),
    # Sub-index 0 of the EDS and of the device is 2.
    Planted(0x2010, group("2010", ARRAY, 4, "2") + "".join(var(f"2010sub{i}", U8) for i in (1, 2, 3)),
            {(0x2010, 0): number(2, 1), (0x2010, 1): bytes(1), (0x2010, 2): bytes(1)},
            ("2010h:03 sub_index_missing eds_wrong eds-count",), {"2010sub3 Remove": (None, "1")}),
    Planted(0x2011, group("2011", RECORD, 3, "2") + var("2011sub1", U8) + var("2011sub2", U8),
            {(0x2011, 0): number(2, 1), (0x2011, 1): bytes(1)}, ("2011h:02 sub_index_missing undecided optional-sub-index",)),
    # The device has fewer sub-indices than its own sub-index 0.
    Planted(0x2012, group("2012", RECORD, 2, "1") + var("2012sub1", U8), {(0x2012, 0): number(9, 1), (0x2012, 1): bytes(1)},
            ("2012h:00 value device_wrong device-sub-index-0",)),
    # CiA 301 does not define sub-index 3 of 1020h, nor a sub-index 0 above 2.
    Planted(0x1020, group("1020", ARRAY, 3, "2") + var("1020sub1", U32) + var("1020sub2", U32),
            {(0x1020, 0): number(3, 1), (0x1020, 1): bytes(4), (0x1020, 2): bytes(4), (0x1020, 3): bytes(4)},
            ("1020h:00 value device_wrong standard-count", "1020h:03 not_in_eds device_wrong undefined-sub-index")),
    # A live value, and one that a user may have stored, are not differences.
    Planted(0x2020, var("2020", U16, "ro", "0"), {(0x2020, 0): number(7, 2)}),
    Planted(0x2021, var("2021", U16, "rw", "0"), {(0x2021, 0): number(7, 2)}),
]


def eds_of(planted: list[Planted]) -> str:
    """Returns the EDS, with the object lists of CiA 306."""
    lists = {"MandatoryObjects": [], "OptionalObjects": [], "ManufacturerObjects": []}
    for row in planted:
        mandatory = row.index in (0x1000, 0x1001, 0x1018)
        name = "MandatoryObjects" if mandatory else "OptionalObjects" if row.index < 0x2000 else "ManufacturerObjects"
        if row.is_listed:
            lists[name].append(row.index)
    text = ("[FileInfo]\nFileName=planted.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n\n[DeviceInfo]\nVendorName=edsc\n"
            "VendorNumber=0x1234\nProductName=Planted\nProductNumber=0x42\nRevisionNumber=0\nBaudRate_500=1\nGranularity=8\n"
            "SimpleBootUpSlave=1\nNrOfRXPDO=0\nNrOfTXPDO=0\nLSS_Supported=0\n")
    for name, indices in lists.items():
        text += f"\n[{name}]\nSupportedObjects={len(indices)}\n"
        text += "".join(f"{i}=0x{index:04X}\n" for i, index in enumerate(sorted(indices), 1))
    return text + "".join(row.eds for row in planted)


class PlantedSlave(Slave):
    def __init__(self, node_id: int, planted: list[Planted]) -> None:
        self.values = {entry: value for row in planted for entry, value in row.values.items()}
        super().__init__(node_id)

    def reset(self) -> None:
        super().reset()
        self.entries = {entry: value for entry, value in self.values.items() if isinstance(value, bytes)}

    def heartbeat(self) -> float:
        return int.from_bytes(self.entries.get((0x1017, 0), b""), "little") / 1000

    def upload(self, entry: Entry) -> None:
        value = self.values.get(entry)
        if value == SILENT:
            return
        if isinstance(value, int):
            self.abort(entry, value)
        elif entry in self.entries:
            super().upload(entry)
        else:
            self.abort(entry, NO_SUB_INDEX if any(index == entry[0] for index, _ in self.values) else NO_OBJECT)


def main() -> None:
    address, node_id, *kind = sys.argv[1:]
    bus = Bus(address)
    slave = PlantedSlave(int(node_id), GOOD if kind == ["good"] else PLANTED)
    print("started", flush=True)
    while True:
        for can_id, data in slave.due(time.monotonic()):
            bus.send(can_id, data)
        for can_id, data in bus.receive(0.05):
            slave.take(can_id, data, time.monotonic())


if __name__ == "__main__":
    main()
