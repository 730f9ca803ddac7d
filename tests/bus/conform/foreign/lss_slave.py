"""An LSS slave (CiA 305). It is silent while `silent_until` is in the future."""

from __future__ import annotations

from collections.abc import Callable

WAITING, CONFIGURATION = 0, 1
UNCONFIGURED = 255
OK, ERROR = 0, 1  # error codes of the answers
TABLE_0 = {0: 1000, 1: 800, 2: 500, 3: 250, 4: 125, 6: 50, 7: 20, 8: 10}  # kbit/s by index


class LssSlave:
    """`identity`: the four numbers of 1018h. `node_id` is the active one, `pending` the one that reset communication makes
    active."""

    def __init__(self, identity: tuple[int, ...], node_id: int, assigned: Callable[[], None]) -> None:
        self.identity = identity
        self.node_id = self.pending = self.stored = node_id
        self.assigned = assigned  # called when a slave without a node-ID gets one
        self.state = WAITING
        self.selected: list[int] = []
        self.identified: list[int] = []
        self.position = 0  # LSSPos of Fastscan
        self.silent_until = 0.0
        self.bit_timing = True     # configuration and activation are supported
        self.takes_node_id = True  # a slave without a node-ID takes one when it leaves the configuration state

    def request(self, data: bytes, now: float) -> bytes | None:
        """Returns the answer to a request of eight bytes, if there is one."""
        command, word = data[0], int.from_bytes(data[1:5], "little")
        if command == 0x04:
            self.switch(data[1])
            return None
        if 0x40 <= command <= 0x43:
            return self.select(command - 0x40, word)
        if 0x46 <= command <= 0x4B:
            return self.identify(command - 0x46, word)
        if command == 0x4C:
            return answer(0x50) if self.is_unconfigured() else None
        if command == 0x51:
            return self.fastscan(word, *data[5:8])
        return self.configure(command, data, now) if self.state == CONFIGURATION else None

    def is_unconfigured(self) -> bool:
        return self.node_id == UNCONFIGURED and self.pending == UNCONFIGURED

    def switch(self, state: int) -> None:
        if state not in (WAITING, CONFIGURATION):
            return
        leaves, self.state = self.state == CONFIGURATION and state == WAITING, state
        if leaves and self.node_id == UNCONFIGURED and self.pending != UNCONFIGURED and self.takes_node_id:
            self.assigned()

    def select(self, step: int, word: int) -> bytes | None:
        self.selected = [*self.selected[:step], word]
        if step != 3 or tuple(self.selected) != self.identity:
            return None
        self.state = CONFIGURATION
        return answer(0x44)

    def identify(self, step: int, word: int) -> bytes | None:
        self.identified = [*self.identified[:step], word]
        if step != 5 or len(self.identified) != 6:
            return None
        vendor, product, revision_low, revision_high, serial_low, serial_high = self.identified
        matches = ((vendor, product) == self.identity[:2] and revision_low <= self.identity[2] <= revision_high and
                   serial_low <= self.identity[3] <= serial_high)
        return answer(0x4F) if matches else None

    def fastscan(self, number: int, bit_check: int, sub: int, following: int) -> bytes | None:
        if not self.is_unconfigured() or self.state == CONFIGURATION:
            return None
        if bit_check == 0x80:
            self.position = 0
            return answer(0x4F)
        if bit_check > 31 or sub > 3 or following > 3 or sub != self.position:
            return None
        if (self.identity[sub] ^ number) >> bit_check:
            return None
        self.position = following
        if bit_check == 0 and following < sub:
            self.state = CONFIGURATION
        return answer(0x4F)

    def configure(self, command: int, data: bytes, now: float) -> bytes | None:
        """Processes the services of the configuration state."""
        if command == 0x11:
            valid = 1 <= data[1] <= 127 or data[1] == UNCONFIGURED
            if valid:
                self.pending = data[1]
            return answer(command, bytes([OK if valid else ERROR]))
        if command == 0x13:
            known = self.bit_timing and data[1] == 0 and data[2] in TABLE_0
            return answer(command, bytes([OK if known else ERROR]))
        if command == 0x15 and self.bit_timing:
            self.silent_until = now + 2 * int.from_bytes(data[1:3], "little") / 1000
        if command == 0x17:
            self.stored = self.pending
            return answer(command, bytes([OK]))
        if 0x5A <= command <= 0x5D:
            return answer(command, self.identity[command - 0x5A].to_bytes(4, "little"))
        return answer(command, bytes([self.node_id])) if command == 0x5E else None


def answer(command: int, data: bytes = b"") -> bytes:
    return (bytes([command]) + data).ljust(8, b"\0")
