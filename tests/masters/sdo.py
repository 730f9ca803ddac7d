"""An SDO client of CiA 301, 7.2.4: expedited and segmented transfers."""

from __future__ import annotations

import struct

from wire import Wire


class Abort(Exception):
    def __init__(self, code: int) -> None:
        super().__init__(f"abort {code:08X}")
        self.code = code


class Silence(Exception):
    def __init__(self) -> None:
        super().__init__("no answer")


class SdoClient:
    def __init__(self, wire: Wire, node_id: int, timeout: float = 3.0) -> None:
        self.wire, self.node_id, self.timeout = wire, node_id, timeout

    def ask(self, request: bytes) -> bytes:
        self.wire.send(0x600 + self.node_id, request)
        answer = self.wire.receive(0x580 + self.node_id, self.timeout)
        if answer is None:
            raise Silence
        if answer[0] == 0x80:
            raise Abort(struct.unpack_from("<I", answer, 4)[0])
        return answer

    def upload(self, index: int, sub: int, size: int | None = None) -> bytes:
        """`size`: number of valid bytes if the answer does not indicate it."""
        answer = self.ask(struct.pack("<BHBI", 0x40, index, sub, 0))
        if answer[0] >> 5 != 2 or answer[1:4] != struct.pack("<HB", index, sub):
            raise ValueError(f"upload is answered with {answer.hex(' ')}")
        if answer[0] & 2:
            return answer[4:8 - (answer[0] >> 2 & 3)] if answer[0] & 1 else answer[4:4 + (size or 4)]
        data, toggle = b"", 0
        while True:
            segment = self.ask(bytes([0x60 | toggle]) + bytes(7))
            if segment[0] & 0xF0 != toggle:
                raise ValueError(f"upload segment is {segment.hex(' ')}")
            data += segment[1:8 - (segment[0] >> 1 & 7)]
            toggle ^= 0x10
            if segment[0] & 1:
                break
        if answer[0] & 1 and struct.unpack_from("<I", answer, 4)[0] != len(data):
            raise ValueError(f"upload of {len(data)} bytes was announced as {answer.hex(' ')}")
        return data

    def download(self, index: int, sub: int, data: bytes) -> None:
        if 1 <= len(data) <= 4:
            answer = self.ask(struct.pack("<BHB", 0x23 | (4 - len(data)) << 2, index, sub) + data.ljust(4, b"\0"))
        else:
            answer = self.ask(struct.pack("<BHBI", 0x21, index, sub, len(data)))
            pieces = [data[i:i + 7] for i in range(0, len(data), 7)] or [b""]
            for number, piece in enumerate(pieces):
                command = (number % 2) << 4 | (7 - len(piece)) << 1 | (number == len(pieces) - 1)
                segment = self.ask(bytes([command]) + piece.ljust(7, b"\0"))
                if segment[0] != 0x20 | (number % 2) << 4:
                    raise ValueError(f"download segment is answered with {segment.hex(' ')}")
        if answer[0] != 0x60 or answer[1:4] != struct.pack("<HB", index, sub):
            raise ValueError(f"download is answered with {answer.hex(' ')}")
