"""What happens to a device in its life, and what it may send: a script for the player, and the judge of its log.

Everything expected comes from the sheet and from CiA 301: the states, the pre-defined connection set, the restricted
CAN-IDs. A COB-ID without a default, or with 0, is that of the pre-defined connection set for PDO 1 to 4, EMCY and SYNC;
other PDOs and SDO servers do not exist then.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field

from .sheet import FLOATS, SIGNED, Entry, Sheet, number_in

INVALID = 1 << 31
FLAG_30 = 1 << 30
EXTENDED = 1 << 29
RESTRICTED = ((0x000, 0x07F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x7FF))
OFF, PRE_OPERATIONAL, OPERATIONAL, STOPPED = "off", "Pre-operational", "Operational", "Stopped"
STATE_CODE = {PRE_OPERATIONAL: 0x7F, OPERATIONAL: 0x05, STOPPED: 0x04}
SECOND = 1_000_000


@dataclass(frozen=True)
class Frame:
    time: int
    id: int
    remote: bool
    extended: bool
    data: bytes

    def __str__(self) -> str:
        return f"{self.id:03X}{' R' if self.remote else ''} {self.data.hex(' ').upper()}".strip()


@dataclass(frozen=True)
class Mapped:
    index: int
    sub_index: int
    bits: int
    offset: int

    @property
    def key(self) -> tuple[int, int]:
        return self.index, self.sub_index


@dataclass(frozen=True)
class Pdo:
    number: int
    cob_id: int
    kind: int  # transmission type
    inhibit: int  # us
    timer: int  # us
    mapping: tuple[Mapped, ...]
    multiplexed: bool

    @property
    def can_id(self) -> int:
        return self.cob_id & (0x1FFF_FFFF if self.cob_id & EXTENDED else 0x7FF)

    @property
    def length(self) -> int:
        return 8 if self.multiplexed else (sum(mapped.bits for mapped in self.mapping) + 7) // 8

    @property
    def exists(self) -> bool:
        return usable(self.cob_id) and (self.multiplexed or 0 < self.length <= 8)

    @property
    def by_event(self) -> bool:
        return self.kind >= 254


def usable(cob_id: int) -> bool:
    """Whether a service may use it: valid, and not restricted."""
    if cob_id & INVALID:
        return False
    return bool(cob_id & EXTENDED) or not any(first <= cob_id & 0x7FF <= last for first, last in RESTRICTED)


def cob_id_of(sheet: Sheet, index: int, sub_index: int, node_id: int, otherwise: int) -> int:
    value = sheet.number(index, sub_index, node_id)
    return value & 0xFFFF_FFFF if value else otherwise


def pdos_of(sheet: Sheet, node_id: int, communication: int, predefined: int) -> list[Pdo]:
    found = []
    for number in range(1, 513):
        index = communication + number - 1
        if not sheet.has(index):
            continue
        otherwise = predefined + 0x100 * (number - 1) + node_id if number <= 4 else INVALID
        kind = sheet.number(index, 2, node_id)
        mapping, offset = [], 0
        count = sheet.number(index + 0x200, 0, node_id)
        if count is None:  # the entries that have a value
            count = next(n for n in range(65) if not sheet.number(index + 0x200, n + 1, node_id))
        for sub_index in range(1, count + 1 if count <= 64 else 1):
            value = sheet.number(index + 0x200, sub_index, node_id) or 0
            mapped = Mapped(value >> 16, value >> 8 & 0xFF, value & 0xFF, offset)
            offset += mapped.bits
            mapping.append(mapped)
        found.append(Pdo(number, cob_id_of(sheet, index, 1, node_id, otherwise), 255 if kind is None else kind & 0xFF,
                         100 * (sheet.number(index, 3, node_id) or 0), 1000 * (sheet.number(index, 5, node_id) or 0),
                         tuple(mapping), count in (254, 255)))
    return found


def bits_of(data: bytes, mapped: Mapped) -> int:
    return int.from_bytes(data, "little") >> mapped.offset & (1 << mapped.bits) - 1


def pattern(entry: Entry, key: tuple[int, int], salt: int, node_id: int) -> int | None:
    """A value that the limits of the sheet allow, as the bits that are on the bus; None: none is known."""
    bits = entry.bits
    if bits is None:
        return None
    if entry.data_type in FLOATS:
        if entry.low or entry.high:
            return None
        return int.from_bytes(struct.pack("<f" if bits == 32 else "<d", 1.5 + salt), "little")
    if bits == 1:
        return salt & 1
    signed = entry.data_type in SIGNED
    least, most = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)
    mask = (1 << bits) - 1
    for text, low in ((entry.low, True), (entry.high, False)):
        if not text:
            continue
        limit = number_in(text, node_id)
        if limit is None:
            return None
        if signed and limit > most:
            limit -= 1 << bits
        least, most = (max(least, limit), most) if low else (least, min(most, limit))
    if least > most:
        return None
    value = least + (0x5A3C_96E1_7B2D_48F1 * (salt + key[0] + 7 * key[1])) % (most - least + 1)
    return value & mask


@dataclass
class Step:
    name: str
    states: tuple[str, ...]
    check: Callable[[list[Frame]], str | None] | None
    frames: list[Frame] = field(default_factory=list)


@dataclass
class Life:
    """One device with one node-ID."""
    sheet: Sheet
    device: str
    node_id: int
    lenient: bool  # edsc has left out what is wrong: PDOs may be missing
    departs: bool  # an options file says where the device departs from CiA 301

    def __post_init__(self) -> None:
        n = self.node_id
        self.lines = [f"device {self.device} {n}"]
        self.steps: list[Step] = []
        self.set_codes: dict[tuple[int, int], int] = {}
        self.expected: dict[tuple[int, int], int] = {}
        self.problems: list[str] = []
        self.state = OFF
        self.tpdos = pdos_of(self.sheet, n, 0x1800, 0x180)
        self.rpdos = pdos_of(self.sheet, n, 0x1400, 0x200)
        self.emcy = cob_id_of(self.sheet, 0x1014, 0, n, 0x80 + n) if self.sheet.has(0x1014) else INVALID
        self.sync = cob_id_of(self.sheet, 0x1005, 0, n, 0x80) if self.sheet.has(0x1005) else INVALID
        self.sync_counter = self.sheet.number(0x1019, 0, n) or 0
        self.servers = []
        for index in range(0x1201, 0x1280):
            request = cob_id_of(self.sheet, index, 1, n, INVALID)
            answer = cob_id_of(self.sheet, index, 2, n, INVALID)
            if usable(request) and usable(answer):
                self.servers.append((index, request & 0x7FF, answer & 0x7FF))
        self.write()

    # ---- what the device may send ----

    @property
    def produces_sync(self) -> bool:
        return bool(self.sync & FLAG_30 and self.sheet.number(0x1006, 0, self.node_id))

    def may_send(self, states: tuple[str, ...]) -> dict[tuple[int, bool], set[int]]:
        """The lengths for each CAN-ID and whether it has 29 bits."""
        n = self.node_id
        allowed: dict[tuple[int, bool], set[int]] = {(0x700 + n, False): {1}}

        def allow(cob_id: int, lengths: set[int]) -> None:
            if usable(cob_id):
                extended = bool(cob_id & EXTENDED)
                can_id = cob_id & (0x1FFF_FFFF if extended else 0x7FF)
                allowed.setdefault((can_id, extended), set()).update(lengths)

        if PRE_OPERATIONAL in states or OPERATIONAL in states:
            allowed[0x580 + n, False] = {8}
            for _, _, answer in self.servers:
                allow(answer, {8})
            allow(self.emcy, {8})
            if self.produces_sync:
                allow(self.sync & ~FLAG_30, {1 if self.sync_counter else 0})
        if OPERATIONAL in states:
            for pdo in self.tpdos:
                if pdo.exists:
                    allow(pdo.cob_id & ~FLAG_30, {pdo.length})
            if self.sheet.compact_pdos:
                for number in range(4):
                    if not self.sheet.has(0x1800 + number):
                        allow(0x180 + 0x100 * number + n, set(range(1, 9)))
        return allowed

    def wrong_frame(self, frame: Frame, states: tuple[str, ...]) -> str | None:
        if frame.remote:
            return "a remote frame"
        lengths = self.may_send(states).get((frame.id, frame.extended))
        if lengths is None:
            return "this CAN-ID is not the device's"
        if len(frame.data) not in lengths:
            return f"expected {' or '.join(map(str, sorted(lengths)))} bytes"
        if frame.id == 0x700 + self.node_id:
            codes = {STATE_CODE[state] for state in states if state != OFF} | ({0} if OFF in states else set())
            if frame.data[0] not in codes:
                return f"is not the code of {' or '.join(states)}"
        return None

    # ---- the script ----

    def step(self, name: str, *commands: str, check=None, to: str = "", over: str = "") -> None:
        states = (self.state, over, to) if over else (self.state, to) if to else (self.state,)
        self.steps.append(Step(name, states, check))
        self.lines.append(f"step {len(self.steps) - 1}")
        self.lines.extend(commands)
        if to:
            self.state = to

    def answers(self, frames: list[Frame]) -> list[bytes]:
        return [frame.data for frame in frames if frame.id == 0x580 + self.node_id]

    def sdo(self, name: str, request: bytes, judge: Callable[[bytes], str | None]) -> None:
        def check(frames: list[Frame]) -> str | None:
            answers = self.answers(frames)
            if len(answers) != 1:
                return f"{len(answers)} SDO answers"
            if len(answers[0]) != 8 or answers[0][1:4] != request[1:4]:
                return f"SDO answer {answers[0].hex(' ')} to {request.hex(' ')}"
            return judge(answers[0])

        self.step(name, f"send {0x600 + self.node_id:X} {request.hex()}", check=check)

    def read(self, name: str, index: int, sub_index: int, value: int | None = None, bits: int = 0) -> None:
        def judge(answer: bytes) -> str | None:
            if answer[0] >> 5 != 2:
                return f"SDO abort code {int.from_bytes(answer[4:], 'little'):08X}h"
            if value is not None and answer[0] & 2:
                got = int.from_bytes(answer[4:], "little") & (1 << bits) - 1
                if got != value & (1 << bits) - 1:
                    return f"reads {got:X}h, expected {value:X}h"
            return None

        self.sdo(name, struct.pack("<BHB4x", 0x40, index, sub_index), judge)

    def read_aborts(self, name: str, index: int, sub_index: int, code: int) -> None:
        self.sdo(name, struct.pack("<BHB4x", 0x40, index, sub_index),
                 lambda answer: None if answer[0] == 0x80 and int.from_bytes(answer[4:], "little") == code
                 else f"expected abort code {code:08X}h, got {answer.hex(' ')}")

    def write_number(self, name: str, index: int, sub_index: int, value: int, size: int) -> None:
        command = 0x23 | (4 - size) << 2
        self.sdo(name, struct.pack("<BHBI", command, index, sub_index, value),
                 lambda answer: None if answer[0] == 0x60 else f"write of {value} got {answer.hex(' ')}")

    def nmt(self, name: str, command: int, node_id: int, to: str, check=None) -> None:
        self.step(name, f"send 0 {command:02X}{node_id:02X}", "run 20000", to=to, check=check)

    def reset(self, name: str, command: int, node_id: int) -> None:
        def check(frames: list[Frame]) -> str | None:
            boots = [frame for frame in frames if frame.id == 0x700 + self.node_id and frame.data == b"\0"]
            return None if len(boots) == 1 else f"{len(boots)} boot-up messages"

        self.step(name, f"send 0 {command:02X}{node_id:02X}", "run 20000", to=PRE_OPERATIONAL, over=OFF, check=check)

    def heartbeats(self, name: str, state: str) -> None:
        """They come every 100 ms, and show the state."""
        if not self.can_set_heartbeat:
            return

        def check(frames: list[Frame]) -> str | None:
            times = [frame.time for frame in frames if frame.id == 0x700 + self.node_id]
            apart = [later - earlier for earlier, later in zip(times, times[1:])]
            if not 4 <= len(times) <= 6 or any(abs(span - 100_000) > 10_000 for span in apart):
                return f"expected 5 heartbeats 100 ms apart, got {len(times)}: {apart}"
            return None

        assert self.state == state
        self.step(name, "run 500000", check=check)

    @staticmethod
    def silent(frames: list[Frame]) -> str | None:
        return f"expected silence, got {frames[0]}" if frames else None

    def no_more_than_heartbeats(self, frames: list[Frame]) -> str | None:
        others = [frame for frame in frames if frame.id != 0x700 + self.node_id]
        return f"is not allowed here: {others[0]}" if others else None

    @property
    def can_set_heartbeat(self) -> bool:
        entry = self.sheet.get(0x1017)
        if not entry or not entry.writable:
            return False
        low, high = number_in(entry.low, 1), number_in(entry.high, 1)
        return not (low and low > 100) and not (high is not None and high < 100)

    def other_node(self) -> int:
        return 100 if self.node_id != 100 else 101

    def frame_of_sync(self) -> str:
        return f"send {self.sync & 0x1FFFFFFF:X} {'01' if self.sync_counter else ''}"

    def write(self) -> None:
        self.power_on()
        self.pre_operational()
        self.operational()
        self.stopped()
        self.again()

    def power_on(self) -> None:
        self.step("before power-on", "run 1000000", check=self.silent)

        def boots(frames: list[Frame]) -> str | None:
            if not frames or frames[0].id != 0x700 + self.node_id or frames[0].data != b"\0":
                return f"expected the boot-up message first, got {frames[0] if frames else 'nothing'}"
            if sum(frame.data == b"\0" and frame.id == 0x700 + self.node_id for frame in frames) != 1:
                return "more than one boot-up message"
            return None

        self.step("power-on", "start", "run 20000", to=PRE_OPERATIONAL, check=boots)

    def reads_something(self, name: str) -> None:
        index = next((index for index in (0x1000, 0x1001, 0x1018) if (entry := self.sheet.get(index)) and entry.readable), 0)
        if index:
            self.read(f"SDO {name}", index, 0)

    def known_value(self, index: int, sub_index: int) -> tuple[int | None, int]:
        entry = self.sheet.get(index, sub_index)
        if not entry or not entry.bits or entry.data_type in FLOATS:
            return None, 0
        return self.sheet.number(index, sub_index, self.node_id), entry.bits

    def pre_operational(self) -> None:
        for index, sub_index in ((0x1000, 0), (0x1018, 0), (0x1018, 1)):
            if (entry := self.sheet.get(index, sub_index)) and entry.readable:
                self.read(f"read {index:X}h:{sub_index:02X}", index, sub_index, *self.known_value(index, sub_index))
        missing = next(index for index in range(0x5FFF, 0x2000, -1) if not self.sheet.has(index))
        self.read_aborts("read a missing object", missing, 0, 0x0602_0000)
        if self.sheet.get(0x1018, 1):
            self.read_aborts("read a missing sub-index", 0x1018, 0xFD, 0x0609_0011)
        for index, request, answer in self.servers:
            self.step(f"SDO server {index:X}h", f"send {request:X} 4000100000000000",
                      check=lambda frames, answer=answer: None if any(f.id == answer for f in frames) else "no answer")
        self.emergency("EMCY in Pre-operational")
        if self.can_set_heartbeat:
            self.write_number("write 1017h", 0x1017, 0, 100, 2)
            self.heartbeats("heartbeats in Pre-operational", PRE_OPERATIONAL)
        self.step("no PDOs in Pre-operational", *self.stimuli(), "run 100000",
                  check=None if self.produces_sync else self.no_pdo)

    def no_pdo(self, frames: list[Frame]) -> str | None:
        return next((f"a PDO: {frame}" for frame in frames if frame.id in {p.can_id for p in self.tpdos if p.exists}), None)

    def stimuli(self) -> list[str]:
        """SYNC, remote frames for TPDOs, RPDOs."""
        commands = [self.frame_of_sync()] if usable(self.sync) else []
        commands += [f"remote {pdo.can_id:X} {pdo.length}" for pdo in self.tpdos if pdo.exists]
        commands += [f"send {pdo.can_id:X} {bytes(pdo.length).hex()}" for pdo in self.rpdos
                     if pdo.exists and not pdo.multiplexed and self.is_the_only_consumer(pdo)]
        return commands

    def is_the_only_consumer(self, pdo: Pdo) -> bool:
        services = [self.sync & 0x1FFFFFFF] + [request for _, request, _ in self.servers]
        others = [other.can_id for other in self.rpdos if other.exists and other is not pdo]
        return pdo.can_id not in services + others

    def emergency(self, name: str) -> None:
        inhibit = 100 * (self.sheet.number(0x1015, 0, self.node_id) or 0)

        def check(code: int) -> Callable[[list[Frame]], str | None]:
            def checked(frames: list[Frame]) -> str | None:
                if not usable(self.emcy):
                    return None
                codes = [int.from_bytes(frame.data[:2], "little") for frame in frames
                         if frame.id == self.emcy & (0x1FFF_FFFF if self.emcy & EXTENDED else 0x7FF)]
                return None if code in codes else f"expected EMCY {code:04X}h, got {[f'{c:04X}h' for c in codes]}"
            return checked

        wait = f"run {20_000 + 10 * inhibit}"
        self.step(name, "emergency FF12", wait, check=check(0xFF12))
        register = self.sheet.get(0x1001)
        if register and register.readable:
            self.read(f"{name}: 1001h", 0x1001, 0, 1, 1)
        self.step(f"{name}: over", "emergency_over", wait, check=check(0))

    # ---- PDOs ----

    def operational(self) -> None:
        self.pdo_steps: list[int] = []
        self.nmt("NMT start", 1, self.node_id, OPERATIONAL)
        self.pdo_steps.append(len(self.steps) - 1)
        self.heartbeats("heartbeats in Operational", OPERATIONAL)
        self.pdo_steps.append(len(self.steps) - 1)
        if self.can_set_heartbeat:
            self.write_number("write 1017h = 0", 0x1017, 0, 0, 2)
        self.reads_something("in Operational")
        self.emergency("EMCY in Operational")
        self.set_mapped_values()
        self.synchronous()
        self.by_timer()
        self.by_remote_frame()
        self.last_of_tpdos = len(self.steps)
        for pdo in self.rpdos:
            self.receive(pdo)

    def set_mapped_values(self) -> None:
        commands = []
        for pdo in self.tpdos:
            for mapped in pdo.mapping if pdo.exists and not pdo.multiplexed else ():
                entry = self.sheet.get(*mapped.key)
                if mapped.index < 0x2000 or entry is None or mapped.key in self.expected:
                    continue
                value = pattern(entry, mapped.key, 1, self.node_id)
                if value is not None and entry.bits == mapped.bits:
                    self.expected[mapped.key] = value
                    size = (entry.bits + 7) // 8
                    commands.append(f"set {mapped.index:X} {mapped.sub_index:X} {value.to_bytes(size, 'little').hex()}")
        wait = max((pdo.inhibit for pdo in self.tpdos), default=0)
        self.step("new values", *commands, f"run {20_000 + 2 * wait}")
        self.pdo_steps.append(len(self.steps) - 1)

    def synchronous(self) -> None:
        if not usable(self.sync) or self.produces_sync:
            return
        kinds = [pdo.kind for pdo in self.tpdos if pdo.exists and pdo.kind <= 240]
        count = max(kinds, default=0) + 2

        def check(frames: list[Frame]) -> str | None:
            for pdo in self.tpdos:
                if not pdo.exists or not 1 <= pdo.kind <= 240 or self.lenient or self.sync_counter:
                    continue
                if not self.is_the_only_producer(pdo):
                    continue
                got = sum(frame.id == pdo.can_id for frame in frames)
                if got != count // pdo.kind:
                    return f"TPDO {pdo.number} of type {pdo.kind}: {got} times after {count} SYNCs"
            return None

        self.step("SYNC", *[self.frame_of_sync()] * count, check=check)
        self.pdo_steps.append(len(self.steps) - 1)

    def is_the_only_producer(self, pdo: Pdo) -> bool:
        return sum(other.exists and other.can_id == pdo.can_id for other in self.tpdos) == 1

    def by_timer(self) -> None:
        for pdo in self.tpdos:
            if not pdo.exists or not pdo.by_event or pdo.multiplexed:
                continue
            period, preset = max(pdo.timer, pdo.inhibit), bool(pdo.timer)
            entry = self.sheet.get(0x1800 + pdo.number - 1, 5)
            if not preset:
                if not entry or not entry.writable or entry.bits != 16 or entry.low or entry.high or self.lenient:
                    continue
                period = max(100_000, pdo.inhibit)
                self.write_number(f"event timer of TPDO {pdo.number}", 0x1800 + pdo.number - 1, 5, 100, 2)
            if period > 20 * SECOND:
                continue

            def check(frames: list[Frame], pdo=pdo) -> str | None:
                got = sum(frame.id == pdo.can_id for frame in frames)
                if got >= 2 or self.lenient or not self.is_the_only_producer(pdo):
                    return None
                return f"TPDO {pdo.number}: {got} times in three periods of its event timer"

            self.step(f"TPDO {pdo.number} by its event timer", f"run {3 * period}", check=check)
            self.pdo_steps.append(len(self.steps) - 1)
            if not preset:
                self.write_number(f"event timer of TPDO {pdo.number} off", 0x1800 + pdo.number - 1, 5, 0, 2)

    def by_remote_frame(self) -> None:
        for pdo in self.tpdos:
            if not pdo.exists or pdo.multiplexed or pdo.cob_id & FLAG_30 or pdo.kind < 252:
                continue
            commands = [self.frame_of_sync()] if usable(self.sync) and pdo.kind == 252 else []

            def check(frames: list[Frame], pdo=pdo) -> str | None:
                if self.lenient or self.departs or any(frame.id == pdo.can_id for frame in frames):
                    return None
                return f"TPDO {pdo.number} does not answer a remote frame"

            self.step(f"TPDO {pdo.number} by a remote frame", *commands, f"remote {pdo.can_id:X} {pdo.length}",
                      f"run {20_000 + pdo.inhibit}", check=check)
            self.pdo_steps.append(len(self.steps) - 1)

    def receive(self, pdo: Pdo) -> None:
        if not pdo.exists or pdo.multiplexed or not self.is_the_only_consumer(pdo):
            return
        if pdo.kind <= 240 and not usable(self.sync):
            return
        content, values = 0, {}
        for mapped in pdo.mapping:
            entry = self.sheet.get(*mapped.key)
            if mapped.index < 0x2000 or entry is None or entry.bits != mapped.bits or mapped.key in values:
                continue
            value = pattern(entry, mapped.key, 3 + pdo.number, self.node_id)
            if value is not None:
                content |= value << mapped.offset
                values[mapped.key] = value
        data = content.to_bytes(pdo.length, "little").hex()
        commands = [f"send {pdo.can_id:X} {data}"]
        if pdo.kind <= 240:  # within the window of 1007h, and taken at the next SYNC
            commands = [self.frame_of_sync().replace("send", "queue"), *commands, self.frame_of_sync()]
        self.step(f"RPDO {pdo.number}", *commands)
        twice = [mapped.key for mapped in pdo.mapping]
        for key, value in values.items():
            entry = self.sheet.get(*key)
            if entry.readable and entry.bits <= 32 and twice.count(key) == 1 and not self.lenient:
                self.read(f"RPDO {pdo.number}: {key[0]:X}h:{key[1]:02X}", *key, value, entry.bits)

    # ---- NMT ----

    def stopped(self) -> None:
        if self.can_set_heartbeat:
            self.write_number("write 1017h again", 0x1017, 0, 100, 2)
        self.nmt("NMT command to another node", 2, self.other_node(), OPERATIONAL)
        self.heartbeats("still Operational", OPERATIONAL)
        self.reads_something("while another node is stopped")
        self.nmt("NMT stop to all nodes", 2, 0, STOPPED)
        self.step("no SDO in Stopped", f"send {0x600 + self.node_id:X} 4000100000000000",
                  check=self.no_more_than_heartbeats)
        self.step("no PDO in Stopped", *self.stimuli(), "run 100000", check=self.no_more_than_heartbeats)
        self.step("no EMCY in Stopped", "emergency FF12", "emergency_over", "run 100000",
                  check=self.no_more_than_heartbeats)
        self.heartbeats("heartbeats in Stopped", STOPPED)
        self.nmt("NMT enter Pre-operational", 0x80, self.node_id, PRE_OPERATIONAL)
        self.heartbeats("heartbeats in Pre-operational again", PRE_OPERATIONAL)
        self.step("an unknown NMT command", f"send 0 55{self.node_id:02X}", "run 20000")
        self.step("an NMT command of one byte", "send 0 01", "run 20000")
        self.heartbeats("still Pre-operational", PRE_OPERATIONAL)
        self.reads_something("in Pre-operational again")

    def again(self) -> None:
        for name, command, target in (("reset communication", 0x82, self.node_id), ("reset node", 0x81, self.node_id),
                                      ("reset of all nodes", 0x81, 0)):
            self.nmt(f"NMT start before {name}", 1, 0, OPERATIONAL)
            self.reset(f"NMT {name}", command, target)
            self.reads_something(f"after {name}")
            if self.can_set_heartbeat:
                value, bits = self.known_value(0x1017, 0)
                self.read(f"1017h after {name}", 0x1017, 0, value or 0, bits or 16)
        self.step("reset of another node", f"send 0 81{self.other_node():02X}", "run 20000")

    # ---- the judge ----

    def judge(self, log: list[str]) -> list[str]:
        """Problems, each with the step where it was seen."""
        current: Step | None = None
        for line in log:
            if line.startswith("= "):
                current = self.steps[int(line[2:])]
            elif line.startswith("# "):
                index, sub_index, code = line[2:].split()
                self.set_codes[int(index, 16), int(sub_index, 16)] = int(code, 16)
            elif current is None or line.startswith("!"):
                self.problems.append(line)
            else:
                time, can_id, data = line.split(" ")
                number = can_id.rstrip("RX")
                current.frames.append(Frame(int(time), int(number, 16), "R" in can_id, "X" in can_id, bytes.fromhex(data)))
        for step in self.steps:
            wrong = next(((frame, reason) for frame in step.frames if (reason := self.wrong_frame(frame, step.states))), None)
            if wrong:
                self.problems.append(f"{step.name}: sends {wrong[0]}: {wrong[1]}")
            problem = step.check(step.frames) if step.check else None
            if problem:
                self.problems.append(f"{step.name}: {problem}")
        if not self.lenient:
            self.judge_tpdos()
        return self.problems

    def judge_tpdos(self) -> None:
        steps = [self.steps[number] for number in sorted(set(self.pdo_steps))]
        for pdo in self.tpdos:
            if not pdo.exists or pdo.multiplexed:
                continue
            frames = [frame for step in steps for frame in step.frames if frame.id == pdo.can_id]
            if not frames:
                if self.is_triggered(pdo):
                    self.problems.append(f"TPDO {pdo.number} of type {pdo.kind} was never sent on {pdo.can_id:X}h")
                continue
            after = [frame for step in self.steps[:self.last_of_tpdos] for frame in step.frames if frame.id == pdo.can_id]
            if not self.is_the_only_producer(pdo) or len(after[-1].data) != pdo.length or len(frames) < 2:
                continue
            for mapped in pdo.mapping:
                if mapped.key in self.expected and self.set_codes.get(mapped.key) == 0:
                    got, expected = bits_of(after[-1].data, mapped), self.expected[mapped.key]
                    if got != expected:
                        self.problems.append(f"TPDO {pdo.number} carries {mapped.index:X}h:{mapped.sub_index:02X} = {got:X}h, "
                                             f"expected {expected:X}h: {after[-1]}")

    def is_triggered(self, pdo: Pdo) -> bool:
        if pdo.kind <= 240:
            return usable(self.sync) and (pdo.kind != 0 or any(self.set_codes.get(m.key) == 0 for m in pdo.mapping))
        if pdo.kind >= 254:
            return True
        return pdo.kind >= 252 and not pdo.cob_id & FLAG_30 and not self.departs
