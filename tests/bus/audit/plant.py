"""A recorded bus of two nodes that behave as their EDS files state, to be broken by tests.

Node 6 produces SYNC, node 5 has PDOs of each kind and consumes the heartbeat of node 6. Times are in milliseconds.
"""

from __future__ import annotations

import binascii
from dataclasses import dataclass, replace

UNSIGNED8, UNSIGNED16, UNSIGNED32, VISIBLE_STRING = 5, 6, 7, 9
WIDTHS = {UNSIGNED8: 1, UNSIGNED16: 2, UNSIGNED32: 4}
PRE_OPERATIONAL, OPERATIONAL, STOPPED = 0x7F, 5, 4
START_MS, STOP_MS, END_MS = 500, 2500, 3000
SYNC_PERIOD_MS, HEARTBEAT_MS, EVENT_MS = 50, 100, 100

Parameters = dict[tuple[int, int], tuple[int, str]]  # (index, sub-index): data type and value


@dataclass(frozen=True)
class Frame:
    ms: float
    can_id: int
    data: bytes = b""
    remote: bool = False

    def line(self) -> str:
        content = "R" if self.remote else self.data.hex().upper()
        return f"({1_700_000_000 + self.ms / 1000:.6f}) can0 {self.can_id:03X}#{content}"


def in_order(frames: list[Frame]) -> list[Frame]:
    return sorted(frames, key=lambda frame: frame.ms)


def log_of(frames: list[Frame]) -> str:
    return "".join(frame.line() + "\n" for frame in frames)


def parameters(**changed: str) -> Parameters:
    """The communication parameters of both nodes; `changed` by names such as i1017 and i1800s05."""
    values: Parameters = {
        (0x1000, 0): (UNSIGNED32, "0"), (0x1001, 0): (UNSIGNED8, "0"), (0x1005, 0): (UNSIGNED32, "0x80"),
        (0x1006, 0): (UNSIGNED32, "0"), (0x1007, 0): (UNSIGNED32, "10000"), (0x1008, 0): (VISIBLE_STRING, "axis"),
        (0x1014, 0): (UNSIGNED32, "$NODEID+0x80"), (0x1015, 0): (UNSIGNED16, "100"), (0x1016, 1): (UNSIGNED32, "0"),
        (0x1017, 0): (UNSIGNED16, "100"), (0x1018, 1): (UNSIGNED32, "1"), (0x1019, 0): (UNSIGNED8, "10"),
        (0x1400, 1): (UNSIGNED32, "$NODEID+0x200"), (0x1400, 2): (UNSIGNED8, "255"), (0x1600, 1): (UNSIGNED32, "0x20010010"),
        (0x2000, 0): (UNSIGNED16, "0"), (0x2001, 0): (UNSIGNED16, "0"),
    }
    for number, transmission_type in enumerate(("255", "1", "252")):
        values[0x1800 + number, 1] = (UNSIGNED32, f"$NODEID+0x{0x180 + 0x100 * number:X}")
        values[0x1800 + number, 2] = (UNSIGNED8, transmission_type)
        values[0x1800 + number, 3] = (UNSIGNED16, "100" if number == 0 else "0")
        values[0x1800 + number, 5] = (UNSIGNED16, "100" if number == 0 else "0")
        values[0x1A00 + number, 1] = (UNSIGNED32, "0x20000010")
    for name, value in changed.items():
        index, _, sub = name[1:].partition("s")
        key = int(index, 16), int(sub or "0", 16)
        values[key] = (values[key][0], value)
    return values


def axis(**changed: str) -> Parameters:
    return parameters(**{"i1016s01": "0x000600FA"} | changed)


def supply(**changed: str) -> Parameters:
    """Node 6: SYNC each 50 ms, and no PDOs."""
    silent = {f"i{0x1800 + number:X}s01": "0x80000000" for number in range(3)}
    return parameters(**{"i1005": "0x40000080", "i1006": "50000"} | silent | changed)


def eds_of(values: Parameters) -> str:
    def entry(section: str, index: int, sub_index: int) -> str:
        data_type, value = values[index, sub_index]
        pdo = int(index in (0x2000, 0x2001))
        return (f"[{section}]\nParameterName=Entry {index:X} {sub_index}\nObjectType=0x7\nDataType=0x{data_type:04X}\n"
                f"AccessType=rw\nDefaultValue={value}\nPDOMapping={pdo}\n")

    text = ["[FileInfo]\nFileName=axis.eds\nFileVersion=1\nFileRevision=1\nEDSVersion=4.0\n"
            "[DeviceInfo]\nVendorName=edsc\nProductName=Axis\nVendorNumber=1\nBaudRate_125=1\nNrOfRXPDO=1\nNrOfTXPDO=3\n"]
    lists: dict[str, list[int]] = {"MandatoryObjects": [], "OptionalObjects": [], "ManufacturerObjects": []}
    for index in sorted({index for index, _ in values}):
        kind = ("MandatoryObjects" if index in (0x1000, 0x1001, 0x1018)
                else "ManufacturerObjects" if index >= 0x2000 else "OptionalObjects")
        lists[kind].append(index)
        subs = sorted(sub for at, sub in values if at == index)
        if subs == [0]:
            text.append(entry(f"{index:X}", index, 0))
            continue
        text.append(f"[{index:X}]\nParameterName=Object {index:X}\nObjectType=0x9\nSubNumber={len(subs) + 1}\n"
                    f"[{index:X}sub0]\nParameterName=Highest sub-index\nObjectType=0x7\nDataType=0x0005\nAccessType=ro\n"
                    f"DefaultValue={max(subs)}\nPDOMapping=0\n")
        text += [entry(f"{index:X}sub{sub:X}", index, sub) for sub in subs]
    for kind, indices in lists.items():
        text.append(f"[{kind}]\nSupportedObjects={len(indices)}\n"
                    + "".join(f"{at + 1}=0x{index:X}\n" for at, index in enumerate(indices)))
    return "".join(text)


def sdo(ms: float, node: int, request: str, response: str, delay: float = 1) -> list[Frame]:
    return [Frame(ms, 0x600 + node, bytes.fromhex(request)), Frame(ms + delay, 0x580 + node, bytes.fromhex(response))]


def block_upload(ms: float) -> list[Frame]:
    """The 14 bytes of 2002h with CRC, read from node 5."""
    data = bytes(range(1, 15))
    crc = binascii.crc_hqx(data, 0).to_bytes(2, "little")
    return [Frame(ms, 0x605, bytes.fromhex("A402200004000000")), Frame(ms + 1, 0x585, bytes.fromhex("C60220000E000000")),
            Frame(ms + 2, 0x605, bytes.fromhex("A300000000000000")), Frame(ms + 3, 0x585, b"\x01" + data[:7]),
            Frame(ms + 4, 0x585, b"\x82" + data[7:]), Frame(ms + 5, 0x605, bytes.fromhex("A202040000000000")),
            Frame(ms + 6, 0x585, b"\xC1" + crc + bytes(5)), Frame(ms + 7, 0x605, bytes.fromhex("A100000000000000"))]


def repeated_block_upload(ms: float) -> list[Frame]:
    """The same, with a wrong sequence number in the second segment, so that it is sent again."""
    begin, end = block_upload(ms)[:4], block_upload(ms + 2)[5:]
    return [*begin, Frame(ms + 4, 0x585, b"\x83" + bytes(range(8, 15))), Frame(ms + 5, 0x605, bytes.fromhex("A201040000000000")),
            Frame(ms + 6, 0x585, b"\x81" + bytes(range(8, 15))), Frame(ms + 7, 0x605, bytes.fromhex("A201040000000000")), *end[1:]]


def segmented_upload(ms: float) -> list[Frame]:
    """The 16 bytes of 1008h, in three segments."""
    text = b"axis of edsc 1.0"
    return [*sdo(ms, 5, "4008100000000000", "4108100010000000"),
            *sdo(ms + 2, 5, "6000000000000000", "00" + text[:7].hex()),
            *sdo(ms + 4, 5, "7000000000000000", "10" + text[7:14].hex()),
            *sdo(ms + 6, 5, "6000000000000000", "0B" + text[14:].hex() + "0000000000")]


def clean() -> list[Frame]:
    frames = [Frame(0, 0x706, b"\0"), Frame(10, 0x705, b"\0")]
    for at, ms in enumerate(range(20, STOP_MS, SYNC_PERIOD_MS)):
        frames.append(Frame(ms, 0x080, bytes([at % 10 + 1])))
        if ms > START_MS:
            frames.append(Frame(ms + 1, 0x285, bytes(2)))
    for node, first in ((6, 100), (5, 110)):
        for ms in range(first, END_MS, HEARTBEAT_MS):
            state = PRE_OPERATIONAL if ms < START_MS + 5 else OPERATIONAL if ms < STOP_MS + 5 else STOPPED
            frames.append(Frame(ms, 0x700 + node, bytes([state])))
    frames += [Frame(START_MS + 3, 0x000, b"\x01\x00"), Frame(STOP_MS + 3, 0x000, b"\x02\x00")]
    frames += [Frame(ms, 0x185, bytes(2)) for ms in range(START_MS + 5, STOP_MS, EVENT_MS)]
    frames += [Frame(1000, 0x385, remote=True), Frame(1002, 0x385, bytes(2)), Frame(1010, 0x205, bytes(2))]
    frames += [Frame(1500, 0x085, bytes.fromhex("1081110000000000")), Frame(1700, 0x085, bytes(8))]
    frames += sdo(600, 5, "4000100000000000", "4300100000000000") + segmented_upload(640) + block_upload(680)
    frames += sdo(710, 5, "2B00200005000000", "6000200000000000")
    frames += [Frame(300, 0x7E5, bytes.fromhex("0401000000000000")), Frame(302, 0x7E5, bytes.fromhex("5E00000000000000")),
               Frame(303, 0x7E4, bytes.fromhex("5E05000000000000")), Frame(305, 0x7E5, bytes.fromhex("0400000000000000"))]
    return frames


def without(frames: list[Frame], can_id: int, from_ms: float, until_ms: float | None = None) -> list[Frame]:
    """Without the first frame of a CAN-ID from a time on, or without all of them until another time."""
    chosen = [frame for frame in frames if frame.can_id == can_id and frame.ms >= from_ms]
    removed = [min(chosen, key=lambda frame: frame.ms)] if until_ms is None else [one for one in chosen if one.ms < until_ms]
    assert removed, f"{can_id:03X}h"
    return [frame for frame in frames if frame not in removed]


def changed(frames: list[Frame], can_id: int, from_ms: float, **changes: object) -> list[Frame]:
    """With another first frame of a CAN-ID from a time on."""
    chosen = min((frame for frame in frames if frame.can_id == can_id and frame.ms >= from_ms), key=lambda frame: frame.ms)
    return [replace(frame, **changes) if frame is chosen else frame for frame in frames]
