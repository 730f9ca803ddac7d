"""The same frames as logs of other programs: candump, python-can, can-utils, scapy, and captures by the specification.

Frames have times in steps of 100 us from 0, which all formats can express.
"""

from __future__ import annotations

import inspect
import random
import struct
import subprocess
from dataclasses import dataclass
from pathlib import Path

SOCKETCAN = 227  # LINKTYPE_CAN_SOCKETCAN
EXTENDED, REMOTE, ERROR = 1 << 31, 1 << 30, 1 << 29


@dataclass
class Frame:
    time_us: int
    can_id: int
    data: bytes = b""
    extended: bool = False
    remote: bool = False

    @property
    def seconds(self) -> str:
        return f"{self.time_us // 1_000_000}.{self.time_us % 1_000_000:06}"

    @property
    def packet(self) -> bytes:
        flags = (EXTENDED if self.extended else 0) | (REMOTE if self.remote else 0)
        return struct.pack(">IB3x", self.can_id | flags, len(self.data)) + self.data


def frames(count: int, seed: int) -> list[Frame]:
    """Of the axis of axis.dcf: PDOs, SDO, error control and unknown CAN-IDs."""
    choose = random.Random(seed)
    result = []
    for number in range(count):
        kind = choose.randrange(8)
        one = Frame(number * 700, 0x706, b"\x05")
        if kind == 0:
            one = Frame(one.time_us, 0x186, b"\x37\x02" + choose.randbytes(4))
        elif kind == 1:
            one = Frame(one.time_us, 0x12346, choose.randbytes(8), extended=True)
        elif kind == 2:
            one = Frame(one.time_us, 0x286, choose.randbytes(8))
        elif kind == 3:
            one = Frame(one.time_us, 0x606, bytes.fromhex("4064600000000000"))
        elif kind == 4:
            one = Frame(one.time_us, 0x586, bytes.fromhex("43646000") + choose.randbytes(4))
        elif kind == 5:
            one = Frame(one.time_us, choose.randrange(0x800), choose.randbytes(choose.randrange(9)))
        elif kind == 6:
            one = Frame(one.time_us, choose.randrange(0x800, 0x2000_0000), choose.randbytes(choose.randrange(9)), extended=True)
        result.append(one)
    return result


def candump(path: Path, log: list[Frame], interface: str = "1", seconds: int = 0) -> None:
    """`seconds`: time of the first frame."""
    with path.open("w") as file:
        for one in log:
            digits = 8 if one.extended else 3
            data = "R" if one.remote else one.data.hex().upper()
            time = Frame(one.time_us + seconds * 1_000_000, 0).seconds
            file.write(f"({time}) {interface} {one.can_id:0{digits}X}#{data}\n")


def message(one: Frame):  # noqa: ANN201
    import can  # noqa: PLC0415

    return can.Message(timestamp=one.time_us / 1e6, arbitration_id=one.can_id, data=one.data, is_extended_id=one.extended,
                       is_remote_frame=one.remote, channel=0)


def python_can_asc(path: Path, log: list[Frame]) -> None:
    from can.io import ASCWriter  # noqa: PLC0415

    writer = ASCWriter(str(path))
    for one in log:
        writer.on_message_received(message(one))
    writer.stop()


def python_can_trc(path: Path, log: list[Frame], version: str) -> None:
    """Version 1.0, with times in whole milliseconds, or 2.1."""
    from can.io.trc import TRCFileVersion, TRCWriter  # noqa: PLC0415

    writer = TRCWriter(str(path))
    writer.file_version = TRCFileVersion[version]
    for one in log:
        writer.on_message_received(message(one))
    writer.stop()


def python_can_blf(path: Path, log: list[Frame], compression: int) -> None:
    from can.io import BLFWriter  # noqa: PLC0415

    writer = BLFWriter(str(path), compression_level=compression)
    writer.max_container_size = 2000  # objects continue in the next container
    for one in log:
        sent = message(one)
        if one.time_us != 0:
            sent.timestamp += 0.5e-6  # it truncates
        writer.on_message_received(sent)
    writer.stop()


def busmaster(path: Path, log: list[Frame], mode: str = "SYSTEM", decimal: bool = False) -> None:
    """As the logs of BUSMASTER 3.2.2 look that users publish; times are in units of 100 us."""
    lines = ["***BUSMASTER Ver 3.2.2***", "***PROTOCOL CAN***", "***NOTE: PLEASE DO NOT EDIT THIS DOCUMENT***",
             "***[START LOGGING SESSION]***", "***START DATE AND TIME 28:11:2026 0:0:0:0***", "***DEC***" if decimal else "***HEX***",
             f"***{mode} MODE***", "***START CHANNEL BAUD RATE***", "***CHANNEL 1 - Kvaser - 500000 bps***",
             "***END CHANNEL BAUD RATE***", "***START DATABASE FILES***", "***END DATABASE FILES***",
             "***<Time><Tx/Rx><Channel><CAN ID><Type><DLC><DataBytes>***"]
    before = 0
    for one in log:
        ticks = (one.time_us - (before if mode == "RELATIVE" else 0)) // 100
        before = one.time_us
        seconds, ticks = divmod(ticks, 10_000)
        time = f"{seconds // 3600:02}:{seconds // 60 % 60:02}:{seconds % 60:02}:{ticks:04}"
        kind = ("x" if one.extended else "s") + ("r" if one.remote else "")
        can_id = f"{one.can_id:08}" if decimal else f"0x{one.can_id:0{8 if one.extended else 3}X}"
        data = "" if one.remote else "".join(f" {byte:03}" if decimal else f" {byte:02X}" for byte in one.data)
        lines.append(f"{time} Rx 1 {can_id} {kind} {len(one.data)}{data}")
    lines += ["***END DATE AND TIME 28:11:2026 0:1:0:0***", "***[STOP LOGGING SESSION]***"]
    path.write_bytes("".join(f"{line}\r\n" for line in lines).encode())


def savvycan(path: Path, log: list[Frame], with_direction: bool = True) -> None:
    """The CSV of SavvyCAN, newer with the direction, older without it; it has no remote frames."""
    lines = ["Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8"]
    for one in log:
        data = "".join(f"{byte:02X}," for byte in one.data.ljust(8, b"\0"))
        lines.append(f"{one.time_us},{one.can_id:08X},{str(one.extended).lower()},Rx,1,{len(one.data)},{data}")
    text = "\n".join(lines) + "\n"
    path.write_text(text if with_direction else text.replace(",Dir,", ",").replace(",Rx,", ","))


def log2asc(path: Path, log: list[Frame], *options: str) -> None:
    source = path.with_suffix(".candump")
    candump(source, log, "can0", 1_000_000_000)  # it regards a time of 0 s as missing
    subprocess.run(["log2asc", *options, "-I", source, "-O", path, "can0"], check=True, timeout=600)


def scapy_capture(path: Path, log: list[Frame], writer_name: str) -> None:
    """`RawPcapWriter` or `RawPcapNgWriter`."""
    import scapy.utils  # noqa: PLC0415

    if writer_name == "RawPcapWriter":
        writer = scapy.utils.RawPcapWriter(str(path), linktype=SOCKETCAN, sync=True)
    else:
        writer = scapy.utils.RawPcapNgWriter(str(path))
        writer.linktype = SOCKETCAN
    writer.write_header(None)
    for one in log:
        seconds, microseconds = divmod(one.time_us, 1_000_000)
        if writer_name == "RawPcapWriter":
            writer.write_packet(one.packet, sec=seconds, usec=microseconds)
        else:
            time = (one.time_us + 0.5) / 1e6  # it truncates
            # Later versions have an interface for each link type.
            has_link_type = "linktype" in inspect.signature(writer._write_packet).parameters
            link_type = {"linktype": SOCKETCAN} if has_link_type else {}
            writer._write_packet(one.packet, sec=time, caplen=len(one.packet), wirelen=len(one.packet), **link_type)
    writer.close()


def pcap(log: list[Frame], order: str = "<", nanoseconds: bool = False, link_type: int = SOCKETCAN) -> bytes:
    """draft-ietf-opsawg-pcap, clauses 4 and 5."""
    capture = struct.pack(order + "IHHIIII", 0xA1B23C4D if nanoseconds else 0xA1B2C3D4, 2, 4, 0, 0, 262144, link_type)
    for one in log:
        seconds, rest = divmod(one.time_us, 1_000_000)
        packet = one.packet
        capture += struct.pack(order + "IIII", seconds, rest * 1000 if nanoseconds else rest, len(packet), len(packet)) + packet
    return capture


def pcapng_block(order: str, kind: int, body: bytes) -> bytes:
    body += bytes(-len(body) % 4)
    return struct.pack(order + "II", kind, len(body) + 12) + body + struct.pack(order + "I", len(body) + 12)


def pcapng_section(order: str = "<") -> bytes:
    return pcapng_block(order, 0x0A0D0D0A, struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1))


def pcapng_interface(name: str, link_type: int = SOCKETCAN, order: str = "<", offset: int | None = None) -> bytes:
    """With the options if_name and if_tsoffset."""
    option = struct.pack(order + "HH", 2, len(name)) + name.encode() + bytes(-len(name) % 4) if name else b""
    if offset is not None:
        option += struct.pack(order + "HHq", 14, 8, offset)
    return pcapng_block(order, 1, struct.pack(order + "HHI", link_type, 0, 0) + option + bytes(4))


def pcapng_packet(interface: int, time_us: int, packet: bytes, order: str = "<") -> bytes:
    body = struct.pack(order + "IIIII", interface, time_us >> 32, time_us & 0xFFFF_FFFF, len(packet), len(packet))
    return pcapng_block(order, 6, body + packet)


def cooked(one: Frame, order: str, protocol: int = 0x000C, hardware: int = 280, second: bool = False) -> bytes:
    """LINKTYPE_LINUX_SLL, or LINKTYPE_LINUX_SLL2; the CAN-ID is in the byte order of the computer."""
    header = (struct.pack(">HHIHBB8x", protocol, 0, 3, hardware, 0, 0) if second else
              struct.pack(">HHH8xH", 0, hardware, 0, protocol))
    return header + struct.pack(order + "I", struct.unpack(">I", one.packet[:4])[0]) + one.packet[4:]


def pcapng(log: list[Frame], order: str = "<", resolution: int | None = None, link_type: int = SOCKETCAN) -> bytes:
    """draft-ietf-opsawg-pcapng, clauses 4.1 to 4.3: a section, an interface with if_tsresol, enhanced packets.

    `resolution`: the option, 9 for nanoseconds, 0x80 | 20 for 2^-20 s; None: microseconds, without the option."""
    capture = pcapng_block(order, 0x0A0D0D0A, struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1))
    option = b"" if resolution is None else struct.pack(order + "HHB3xHH", 9, 1, resolution, 0, 0)
    capture += pcapng_block(order, 1, struct.pack(order + "HHI", link_type, 0, 0) + option)
    exponent = 6 if resolution is None else resolution
    per_second = 2 ** (exponent & 0x7F) if exponent & 0x80 else 10 ** exponent
    for one in log:
        ticks = -(-one.time_us * per_second // 1_000_000)  # the first tick that is not earlier
        packet = one.packet
        body = struct.pack(order + "IIIII", 0, ticks >> 32, ticks & 0xFFFF_FFFF, len(packet), len(packet))
        capture += pcapng_block(order, 6, body + packet + bytes(-len(packet) % 4))
    return capture
