"""An SDO server: expedited, segmented and block transfer (CiA 301, 7.2.4.3). `read`, `write` and `check_writable`, which is called
when a download begins, access the dictionary and raise Abort."""

from __future__ import annotations

import binascii
from collections.abc import Callable
from dataclasses import dataclass

from .dictionary import BLOCK_SIZE, COMMAND, CRC, LENGTH, SEQUENCE_NUMBER, TOGGLE_BIT, Abort, Key

SEGMENT = 7  # bytes
MOST_SEGMENTS = 127  # of a block
WITH_CRC, WITH_SIZE = 4, 2  # bits of the initiate requests of block transfer


@dataclass
class Transfer:
    """`kind`: the method that processes the next request."""
    kind: str
    key: Key
    value: bytes = b""
    size: int | None = None   # as the client has indicated
    toggle: int = 0
    crc: bool = False
    segments: int = 0         # of a block
    sequence: int = 0         # of the last segment in the block
    start: int = 0            # of the block in `value`


class SdoServer:
    def __init__(self, read: Callable[[Key], bytes], write: Callable[[Key, bytes], None],
                 check_writable: Callable[[Key], object], blocks: bool = True) -> None:
        self.read, self.write, self.check_writable, self.blocks = read, write, check_writable, blocks
        self.transfer: Transfer | None = None

    def request(self, data: bytes) -> list[bytes]:
        """Returns the responses to a request of eight bytes."""
        key = (int.from_bytes(data[1:3], "little"), data[3])
        try:
            if self.transfer and self.transfer.kind == "block_segment" and data[0] != 0x80:
                return self.block_segment(data)
            return getattr(self, self.service(data))(key, data)
        except Abort as abort:
            if self.transfer:
                key = self.transfer.key
            self.transfer = None
            return [bytes([0x80]) + mux(key) + abort.code.to_bytes(4, "little")]

    def service(self, data: bytes) -> str:
        specifier = data[0] >> 5
        block = {5: {0: "upload_block", 1: "upload_end", 2: "upload_confirmed", 3: "upload_start"},
                 6: {0: "download_block", 1: "download_end"}}
        if specifier in block and self.blocks:
            return block[specifier].get(data[0] & (3 if specifier == 5 else 1), "unknown")
        return {0: "download_segment", 1: "download", 2: "upload", 3: "upload_segment", 4: "aborted"}.get(specifier, "unknown")

    def expect(self, kind: str) -> Transfer:
        if self.transfer is None or self.transfer.kind != kind:
            raise Abort(COMMAND)
        return self.transfer

    def unknown(self, key: Key, data: bytes) -> list[bytes]:
        raise Abort(COMMAND)

    def aborted(self, key: Key, data: bytes) -> list[bytes]:
        self.transfer = None
        return []

    # ---- expedited and segmented ----

    def upload(self, key: Key, data: bytes) -> list[bytes]:
        self.transfer = None
        value = self.read(key)
        if 1 <= len(value) <= 4:
            return [bytes([0x43 | 4 - len(value) << 2]) + mux(key) + value.ljust(4, b"\0")]
        self.transfer = Transfer("upload_segment", key, value)
        return [bytes([0x41]) + mux(key) + len(value).to_bytes(4, "little")]

    def upload_segment(self, key: Key, data: bytes) -> list[bytes]:
        transfer = self.expect("upload_segment")
        self.check_toggle(transfer, data)
        piece, transfer.value = transfer.value[:SEGMENT], transfer.value[SEGMENT:]
        last = not transfer.value
        if last:
            self.transfer = None
        transfer.toggle ^= 1
        return [bytes([(transfer.toggle ^ 1) << 4 | SEGMENT - len(piece) << 1 | last]) + piece.ljust(SEGMENT, b"\0")]

    def download(self, key: Key, data: bytes) -> list[bytes]:
        self.transfer = None
        expedited, with_size = data[0] & 2, data[0] & 1
        if expedited:
            self.write(key, data[4:8 - (data[0] >> 2 & 3)] if with_size else data[4:])
        else:
            self.check_writable(key)
            self.transfer = Transfer("download_segment", key, size=int.from_bytes(data[4:], "little") if with_size else None)
        return [bytes([0x60]) + mux(key) + bytes(4)]

    def download_segment(self, key: Key, data: bytes) -> list[bytes]:
        transfer = self.expect("download_segment")
        self.check_toggle(transfer, data)
        transfer.value += data[1:8 - (data[0] >> 1 & 7)]
        if data[0] & 1:
            self.finish(transfer)
        transfer.toggle ^= 1
        return [bytes([0x20 | (transfer.toggle ^ 1) << 4]) + bytes(7)]

    def check_toggle(self, transfer: Transfer, data: bytes) -> None:
        if data[0] >> 4 & 1 != transfer.toggle:
            raise Abort(TOGGLE_BIT)

    def finish(self, transfer: Transfer) -> None:
        if transfer.size is not None and transfer.size != len(transfer.value):
            raise Abort(LENGTH)
        self.write(transfer.key, transfer.value)
        self.transfer = None

    # ---- block upload ----

    def upload_block(self, key: Key, data: bytes) -> list[bytes]:
        self.transfer = None
        if not 1 <= data[4] <= MOST_SEGMENTS:
            raise Abort(BLOCK_SIZE)
        value = self.read(key)
        self.transfer = Transfer("upload_start", key, value, crc=bool(data[0] & WITH_CRC), segments=data[4])
        return [bytes([0xC0 | WITH_CRC | WITH_SIZE]) + mux(key) + len(value).to_bytes(4, "little")]

    def upload_start(self, key: Key, data: bytes) -> list[bytes]:
        transfer = self.expect("upload_start")
        transfer.kind = "upload_confirmed"
        return self.block(transfer)

    def block(self, transfer: Transfer) -> list[bytes]:
        """Returns the segments of the block at `start`."""
        count = max(1, -(-len(transfer.value) // SEGMENT))  # a value without bytes has one segment
        first = transfer.start // SEGMENT
        frames = []
        for sequence, segment in enumerate(range(first, min(count, first + transfer.segments)), start=1):
            piece = transfer.value[segment * SEGMENT:(segment + 1) * SEGMENT].ljust(SEGMENT, b"\0")
            frames.append(bytes([sequence | (0x80 if segment == count - 1 else 0)]) + piece)
        transfer.sequence = len(frames)
        return frames

    def upload_confirmed(self, key: Key, data: bytes) -> list[bytes]:
        transfer = self.expect("upload_confirmed")
        confirmed, segments = data[1], data[2]
        if confirmed > transfer.sequence:
            raise Abort(SEQUENCE_NUMBER)
        if not 1 <= segments <= MOST_SEGMENTS:
            raise Abort(BLOCK_SIZE)
        transfer.start, transfer.segments = transfer.start + confirmed * SEGMENT, segments
        if transfer.start < max(1, len(transfer.value)):
            return self.block(transfer)
        transfer.kind = "upload_end"
        unused = -len(transfer.value) % SEGMENT if transfer.value else SEGMENT
        return [bytes([0xC1 | unused << 2]) + crc_of(transfer) + bytes(5)]

    def upload_end(self, key: Key, data: bytes) -> list[bytes]:
        self.expect("upload_end")
        self.transfer = None
        return []

    # ---- block download ----

    def download_block(self, key: Key, data: bytes) -> list[bytes]:
        self.transfer = None
        self.check_writable(key)
        size = int.from_bytes(data[4:], "little") if data[0] & WITH_SIZE else None
        self.transfer = Transfer("block_segment", key, size=size, crc=bool(data[0] & WITH_CRC), segments=MOST_SEGMENTS)
        return [bytes([0xA0 | WITH_CRC]) + mux(key) + bytes([MOST_SEGMENTS, 0, 0, 0])]

    def block_segment(self, data: bytes) -> list[bytes]:
        transfer = self.transfer
        sequence, last = data[0] & 0x7F, data[0] & 0x80
        if sequence == transfer.sequence + 1:
            transfer.sequence = sequence
            transfer.value += data[1:]
            if last:
                transfer.kind = "download_end"
        if not last and sequence < transfer.segments:
            return []
        confirmed, transfer.sequence = transfer.sequence, 0
        return [bytes([0xA2, confirmed, transfer.segments]) + bytes(5)]

    def download_end(self, key: Key, data: bytes) -> list[bytes]:
        transfer = self.expect("download_end")
        unused = data[0] >> 2 & 7
        transfer.value = transfer.value[:len(transfer.value) - unused]
        if transfer.crc and data[1:3] != crc_of(transfer):
            raise Abort(CRC)
        self.finish(transfer)
        return [bytes([0xA1]) + bytes(7)]


def mux(key: Key) -> bytes:
    return key[0].to_bytes(2, "little") + bytes([key[1]])


def crc_of(transfer: Transfer) -> bytes:
    """The CRC of CiA 301, 7.2.4.3.16; 0 if the transfer has none."""
    return (binascii.crc_hqx(transfer.value, 0) if transfer.crc else 0).to_bytes(2, "little")
