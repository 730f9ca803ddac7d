"""A CANopen device without edsc's code, with the services of device.eds: SDO, NMT, heartbeat, guarding, SYNC, EMCY, PDO, stored
parameters and LSS, each as CiA 301 and CiA 305 say. It receives and sends frames in `now`, seconds of any clock.

`Switches` are its behaviours: differences from a device that has no fault and is alone on a good bus.
"""

from __future__ import annotations

import random
from collections import deque
from dataclasses import dataclass, replace
from pathlib import Path

from .dictionary import INCOMPATIBLE, INVALID_VALUE, NO_DATA, NOT_STORED, Abort, Dictionary, Key
from .frames import Frame
from .lss_slave import UNCONFIGURED, LssSlave
from .pdos import CAN_ID, MAPPING, Rpdo, Tpdo, check_can_id, check_cob_id, is_invalid
from .sdo_server import SdoServer

INITIALISATION, STOPPED, OPERATIONAL, PRE_OPERATIONAL = 0, 4, 5, 127
START, STOP, ENTER_PRE_OPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 1, 2, 128, 129, 130
LSS_REQUEST, LSS_ANSWER = 0x7E5, 0x7E4
PRODUCES_SYNC = 1 << 30

ERROR_REGISTER, ERROR_HISTORY, SYNC, SYNC_PERIOD = 0x1001, 0x1003, 0x1005, 0x1006
GUARD_TIME, LIFE_TIME_FACTOR, STORE, RESTORE, EMCY, EMCY_INHIBIT = 0x100C, 0x100D, 0x1010, 0x1011, 0x1014, 0x1015
CONSUMER, HEARTBEAT, IDENTITY = 0x1016, 0x1017, 0x1018
NOT_STORED_OBJECTS = (ERROR_REGISTER, ERROR_HISTORY, STORE, RESTORE)
TEXT, INPUT, INPUT_STATUS = (0x2001, 0), (0x2100, 0), (0x2101, 0)

# Emergency error codes and their bits of the error register (CiA 301, 7.2.7.1, tables 26 and 27).
GENERIC_ERROR, LOST, PDO_TOO_SHORT = 0x1000, 0x8130, 0x8210
GENERIC, COMMUNICATION = 0x01, 0x10
ERROR_BITS = {GENERIC_ERROR: GENERIC, LOST: GENERIC | COMMUNICATION, PDO_TOO_SHORT: GENERIC | COMMUNICATION}


@dataclass(frozen=True)
class Switches:
    """Each False, 0 or empty in a good device."""
    ends_at_reset: bool = False            # the program ends at reset node and reset communication, as without a supervisor
    starts_by_itself: bool = False         # Operational after the boot-up message
    loses_node_id: bool = False            # without a node-ID it takes one only after power-on
    error_set: bool = False                # a generic error that does not end: it does not stay in Operational
    answer_delay: float = 0.0              # of SDO responses, seconds
    empty_text: bool = False               # 2001h has no characters
    no_bit_timing: bool = False            # LSS has no services for it
    refreshes: float = 0.0                 # seconds between two changes of the process values
    vanishes_after: int = 0                # number of SDO requests
    random_delay: float = 0.0              # of each frame, at most, seconds
    keeps_times: bool = False              # reset communication does not restore 100Ch, 100Dh and 1017h
    no_lss: bool = False                   # no LSS at all
    rpdo_in_pre_operational: bool = False  # RPDOs are processed in Pre-operational as well
    heartbeat_factor: float = 1.0          # of the time of 1017h
    wrong_emcy_register: bool = False      # the error register of each EMCY is 01h
    no_emcy_inhibit: bool = False          # 1015h has no effect
    emcy_inhibit_read_only: bool = False   # 1015h cannot be written, although the EDS says so
    no_blocks: bool = False                # no block transfer
    sends_at_start: bool = False           # entering Operational is an event of the TPDO
    store_delay: float = 0.0               # of responses to "save" and "load", seconds
    restarts_after: int = 0                # number of SDO requests: its power fails for a moment, once
    joins_at_reset: bool = False           # it has no power until the first reset of another device with its node-ID


class Device:
    def __init__(self, sheet: Path, node_id: int, switches: Switches = Switches(), seed: int = 1) -> None:
        self.switches = switches
        self.random = random.Random(seed)
        self.dictionary = Dictionary(sheet, node_id)
        if switches.emcy_inhibit_read_only:
            entry = self.dictionary.entries[EMCY_INHIBIT, 0]
            self.dictionary.entries[EMCY_INHIBIT, 0] = replace(entry, access="ro")
        self.sheet = sheet
        self.now = 0.0
        self.ended = False
        self.state = INITIALISATION
        self.stored: dict[Key, bytes] = {}
        self.outbox: deque[tuple[float, Frame]] = deque()
        self.last_at = 0.0            # of the outbox: frames keep their sequence
        self.requests = 0             # of SDO
        self.next_refresh: float | None = None
        identity = tuple(self.dictionary.number(IDENTITY, sub) for sub in range(1, 5))
        self.lss = LssSlave(identity, node_id, lambda: self.reset(RESET_COMMUNICATION))
        self.lss.bit_timing = not switches.no_bit_timing
        self.lss.takes_node_id = not switches.loses_node_id
        self.stop_services()

    @property
    def node_id(self) -> int:
        return self.lss.node_id

    def start(self, now: float) -> None:
        """Power-on."""
        self.now = now
        if self.switches.joins_at_reset:
            self.ended = True
        else:
            self.reset(RESET_NODE)

    # ---- frames ----

    def send(self, can_id: int, data: bytes, delay: float = 0.0) -> None:
        if self.now < self.lss.silent_until or self.ended:
            return
        delay += self.random.uniform(0.0, self.switches.random_delay)
        self.last_at = max(self.last_at, self.now + delay)
        self.outbox.append((self.last_at, Frame(can_id, data)))

    def receive(self, frame: Frame, now: float) -> None:
        self.now = now
        if frame.extended:
            return
        if self.ended and self.switches.joins_at_reset and frame.can_id == 0 and frame.data[0] in (RESET_NODE, RESET_COMMUNICATION):
            self.ended = False
            self.reset(RESET_NODE)
            return
        if self.ended or now < self.lss.silent_until:
            return
        if frame.can_id == LSS_REQUEST and not frame.remote and len(frame.data) == 8 and not self.switches.no_lss:
            if (answer := self.lss.request(frame.data, now)) is not None:
                self.send(LSS_ANSWER, answer)
        elif self.state == INITIALISATION:
            return
        elif frame.can_id == 0 and len(frame.data) == 2 and frame.data[1] in (0, self.node_id):
            self.command(frame.data[0])
        elif frame.can_id == 0x700 + self.node_id and frame.remote:
            self.on_guarding()
        elif 0x700 < frame.can_id < 0x780 and not frame.remote:
            self.on_heartbeat(frame.can_id - 0x700)
        elif self.state != STOPPED:
            self.on_service(frame)

    def on_service(self, frame: Frame) -> None:
        """SDO, SYNC and PDO."""
        if frame.can_id == 0x600 + self.node_id and len(frame.data) == 8:
            self.on_sdo(frame.data)
        elif frame.can_id == self.dictionary.number(SYNC) & 0x7FF and not frame.remote:
            self.on_sync()
        elif frame.can_id == self.tpdo.can_id and frame.remote and self.state == OPERATIONAL:
            self.send_all(self.tpdo.on_request(self.now))
        elif frame.can_id == self.rpdo.can_id and self.rpdo.valid and not frame.remote:
            if self.state == OPERATIONAL or self.switches.rpdo_in_pre_operational:
                self.on_rpdo(frame.data)

    def send_all(self, frames: list[Frame]) -> None:
        for frame in frames:
            self.send(frame.can_id, frame.data)

    def poll(self, now: float) -> list[Frame]:
        """Runs what is due, and returns what is sent now."""
        self.now = now
        if not self.ended and self.state != INITIALISATION:
            self.poll_error_control()
            self.poll_process()
            self.poll_emcy()
        frames = []
        while self.outbox and self.outbox[0][0] <= now:
            frames.append(self.outbox.popleft()[1])
        return frames

    def deadline(self) -> float:
        """Returns when `poll` must be called at the latest."""
        times = [self.now + 1.0, *(at for at, _ in list(self.outbox)[:1])]
        times += [at for at in (self.next_beat, self.next_sync, self.next_refresh, self.guard_until) if at is not None]
        times += self.consumed_until.values()
        if self.emcys:
            times.append(self.emcy_free_at)
        return min([*times, *(self.tpdo.deadlines() if self.state == OPERATIONAL else [])])

    # ---- NMT ----

    def command(self, command: int) -> None:
        if command in (RESET_NODE, RESET_COMMUNICATION):
            if self.switches.ends_at_reset:
                self.ended = True
            else:
                self.reset(command)
        elif command in (START, STOP, ENTER_PRE_OPERATIONAL):
            self.enter({START: OPERATIONAL, STOP: STOPPED, ENTER_PRE_OPERATIONAL: PRE_OPERATIONAL}[command])

    def enter(self, state: int) -> None:
        if state == OPERATIONAL and self.errors.get(GENERIC_ERROR):
            state = PRE_OPERATIONAL  # by local control (CiA 301, 7.3.2.2)
        changed, self.state = state != self.state, state
        if not changed:
            return
        if state == OPERATIONAL:
            self.tpdo.start(self.now, self.switches.sends_at_start)
        else:
            self.tpdo.stop()
        if state == STOPPED:
            self.sdo.transfer = None
            self.next_sync = None
        else:
            self.start_sync()

    def reset(self, command: int) -> None:
        self.state = INITIALISATION
        node_id = self.lss.node_id = self.lss.stored if command == RESET_NODE else self.lss.pending
        self.lss.pending = node_id
        if node_id == UNCONFIGURED:
            self.stop_services()
            return
        self.restore(command, node_id)
        self.stop_services()
        self.tpdo, self.rpdo = Tpdo(self.dictionary), Rpdo(self.dictionary)
        self.sdo = SdoServer(self.read, self.write, self.dictionary.check_writable, blocks=not self.switches.no_blocks)
        if command == RESET_NODE:
            self.history: list[int] = []
        self.send(0x700 + node_id, bytes([INITIALISATION]))
        self.state = PRE_OPERATIONAL
        self.start_heartbeat()
        self.start_sync()
        if self.switches.error_set:
            self.raise_error(GENERIC_ERROR)
        if self.switches.starts_by_itself:
            self.enter(OPERATIONAL)

    def restore(self, command: int, node_id: int) -> None:
        """Loads the power-on values: of 1000h to 1FFFh, and at reset node of all objects."""
        values = Dictionary(self.sheet, node_id).defaults() | self.stored
        if command == RESET_COMMUNICATION:
            values = {key: value for key, value in values.items() if key[0] < 0x2000}
            if self.switches.keeps_times:
                values = {key: value for key, value in values.items() if key[0] not in (GUARD_TIME, LIFE_TIME_FACTOR, HEARTBEAT)}
        self.dictionary.load(values)
        if self.switches.empty_text:
            self.dictionary.values[TEXT] = b""

    def stop_services(self) -> None:
        self.outbox.clear()
        self.toggle = 0
        self.next_beat: float | None = None
        self.next_sync: float | None = None
        self.guard_until: float | None = None        # end of the node life time
        self.consumed_until: dict[int, float] = {}   # by monitored node
        self.errors: dict[int, set[object]] = {}     # by emergency error code: what has the error
        self.emcys: deque[bytes] = deque()
        self.emcy_free_at = 0.0
        self.next_refresh = self.now if self.switches.refreshes else None

    # ---- error control ----

    def start_heartbeat(self) -> None:
        period = self.heartbeat_time()
        self.next_beat = self.now + period if period else None
        if period:
            self.guard_until = None

    def heartbeat_time(self) -> float:
        return self.dictionary.number(HEARTBEAT) / 1000 * self.switches.heartbeat_factor

    def poll_error_control(self) -> None:
        if self.next_beat is not None and self.now >= self.next_beat:
            self.send(0x700 + self.node_id, bytes([self.state]))
            late = self.now - self.next_beat > self.heartbeat_time()
            self.next_beat = (self.now if late else self.next_beat) + self.heartbeat_time()
        if self.next_sync is not None and self.now >= self.next_sync:
            self.send(self.dictionary.number(SYNC) & 0x7FF, b"")
            period = self.dictionary.number(SYNC_PERIOD) / 1e6
            self.next_sync = (self.now if self.now - self.next_sync > period else self.next_sync) + period
            self.on_sync()
        if self.guard_until is not None and self.now >= self.guard_until:
            self.guard_until = None
            self.on_lost("guarding")
        for node, until in list(self.consumed_until.items()):
            if self.now >= until:
                del self.consumed_until[node]
                self.on_lost(node)

    def on_guarding(self) -> None:
        if self.heartbeat_time():
            return
        self.send(0x700 + self.node_id, bytes([self.toggle << 7 | self.state]))
        self.toggle ^= 1
        self.end_error(LOST, "guarding")
        life_time = self.dictionary.number(GUARD_TIME) * self.dictionary.number(LIFE_TIME_FACTOR) / 1000
        self.guard_until = self.now + life_time if life_time else None

    def on_heartbeat(self, node: int) -> None:
        time = self.consumer_times().get(node)
        if time is not None:
            self.end_error(LOST, node)
            self.consumed_until[node] = self.now + time

    def consumer_times(self) -> dict[int, float]:
        values = [self.dictionary.number(CONSUMER, sub) for sub in range(1, self.dictionary.number(CONSUMER, 0) + 1)]
        return {value >> 16 & 0xFF: (value & 0xFFFF) / 1000 for value in values if value & 0xFFFF and value >> 16 & 0xFF}

    def on_lost(self, what: object) -> None:
        self.raise_error(LOST, what)
        if self.state == OPERATIONAL:
            self.enter(PRE_OPERATIONAL)  # the default of 1029h:01

    # ---- EMCY ----

    def raise_error(self, code: int, what: object = None) -> None:
        if code not in self.errors:
            self.errors[code] = set()
            self.history = [code, *self.history][:self.highest(ERROR_HISTORY)]
            self.send_emcy(code, ERROR_BITS[code])
        self.errors[code].add(what)

    def end_error(self, code: int, what: object = None) -> None:
        if code in self.errors:
            self.errors[code].discard(what)
            if not self.errors[code]:
                del self.errors[code]
                self.send_emcy(0, 0)

    def error_register(self) -> int:
        register = 0
        for code in self.errors:
            register |= ERROR_BITS[code]
        return register

    def send_emcy(self, code: int, bits: int) -> None:
        register = GENERIC if self.switches.wrong_emcy_register else self.error_register() | bits
        self.emcys.append(code.to_bytes(2, "little") + bytes([register, 0, 0, 0, 0, 0]))
        self.poll_emcy()

    def poll_emcy(self) -> None:
        cob_id = self.dictionary.number(EMCY)
        while self.emcys and self.now >= self.emcy_free_at and self.state != STOPPED:
            data = self.emcys.popleft()
            if not is_invalid(cob_id):
                self.send(cob_id & 0x7FF, data)
                inhibit_time = 0 if self.switches.no_emcy_inhibit else self.dictionary.number(EMCY_INHIBIT) / 10000
                self.emcy_free_at = self.now + inhibit_time

    # ---- SYNC and PDO ----

    def start_sync(self) -> None:
        period = self.dictionary.number(SYNC_PERIOD) / 1e6
        produces = self.dictionary.number(SYNC) & PRODUCES_SYNC and period
        self.next_sync = self.now + period if produces else None

    def on_sync(self) -> None:
        if self.state == OPERATIONAL:
            self.rpdo.on_sync()
            self.send_all(self.tpdo.on_sync(self.now))

    def on_rpdo(self, data: bytes) -> None:
        if self.rpdo.receive(data):
            self.end_error(PDO_TOO_SHORT)
        else:
            self.raise_error(PDO_TOO_SHORT)

    def stimulate(self, what: str, now: float) -> None:
        """The process value changes, or an error begins or ends: the names of stimuli of `edsc conform`."""
        self.now = now
        if what == "change":
            self.change_input()
        elif what == "error":
            self.raise_error(GENERIC_ERROR)
        elif what == "error_over":
            self.end_error(GENERIC_ERROR)
        elif what == "power_cycle":
            self.reset(RESET_NODE)

    def change_input(self) -> None:
        self.dictionary.set(*INPUT, (self.dictionary.number(*INPUT) + 1) % 0x10000)

    def poll_process(self) -> None:
        if self.next_refresh is not None and self.now >= self.next_refresh:
            self.next_refresh = self.now + self.switches.refreshes
            self.change_input()
            self.dictionary.set(*INPUT_STATUS, self.dictionary.number(*INPUT_STATUS) ^ 1)
        if self.state == OPERATIONAL:
            self.send_all(self.tpdo.poll(self.now))

    # ---- SDO ----

    def on_sdo(self, data: bytes) -> None:
        self.requests += 1
        if self.switches.vanishes_after and self.requests > self.switches.vanishes_after:
            self.ended = True
            self.outbox.clear()
        if self.switches.restarts_after and self.requests == self.switches.restarts_after:
            self.reset(RESET_NODE)
            return
        stores = data[0] >> 5 == 1 and int.from_bytes(data[1:3], "little") in (STORE, RESTORE)
        delay = self.switches.answer_delay + (self.switches.store_delay if stores else 0.0)
        for response in self.sdo.request(data):
            self.send(0x580 + self.node_id, response, delay)

    def highest(self, index: int) -> int:
        return max(sub for found, sub in self.dictionary.entries if found == index)

    def read(self, key: Key) -> bytes:
        value = self.dictionary.readable(key)
        index, sub = key
        if index == ERROR_REGISTER:
            return bytes([self.error_register()])
        if index == ERROR_HISTORY:
            if sub > len(self.history):
                raise Abort(NO_DATA)
            return bytes([len(self.history)]) if sub == 0 else self.history[sub - 1].to_bytes(4, "little")
        if index in (STORE, RESTORE) and sub:
            return (1).to_bytes(4, "little")  # on command
        return value

    def write(self, key: Key, data: bytes) -> None:
        if key[0] in (STORE, RESTORE) and key in self.dictionary.entries and key[1]:
            self.dictionary.check_write(key, data)
            self.store(key, data)
            return
        self.dictionary.check_write(key, data)
        self.check_write(key, int.from_bytes(data, "little"))
        self.dictionary.values[key] = data
        self.written(key)

    def check_write(self, key: Key, value: int) -> None:
        """Raises Abort for values that an object of CiA 301 does not accept."""
        index, sub = key
        before = self.dictionary.number(*key)
        if index == ERROR_HISTORY and value:
            raise Abort(INVALID_VALUE)
        if index == SYNC:
            check_can_id(value)
            if before & value & PRODUCES_SYNC and (before ^ value) & CAN_ID:
                raise Abort(INVALID_VALUE)
        if index == EMCY:
            if value & PRODUCES_SYNC:  # bit 30 is reserved
                raise Abort(INVALID_VALUE)
            check_cob_id(before, value)
        if index == CONSUMER and sub:
            self.check_consumer(sub, value)
        for pdo in (self.rpdo, self.tpdo):
            if index in (pdo.index, pdo.index + MAPPING):
                pdo.check_write(key, value)

    def check_consumer(self, sub: int, value: int) -> None:
        node = value >> 16 & 0xFF
        if value & 0xFFFF == 0 or node == 0:
            return
        if node > 127:
            raise Abort(INVALID_VALUE)
        others = [self.dictionary.number(CONSUMER, other) for other in range(1, self.highest(CONSUMER) + 1) if other != sub]
        if any(other & 0xFFFF and other >> 16 & 0xFF == node for other in others):
            raise Abort(INCOMPATIBLE)

    def written(self, key: Key) -> None:
        """Starts what a new value starts."""
        index = key[0]
        if index == HEARTBEAT:
            self.start_heartbeat()
        elif index in (SYNC, SYNC_PERIOD):
            self.start_sync()
        elif index == ERROR_HISTORY:
            self.history = []
        elif index in (GUARD_TIME, LIFE_TIME_FACTOR):
            self.guard_until = None
        elif index == CONSUMER:
            times = self.consumer_times()
            self.consumed_until = {node: until for node, until in self.consumed_until.items() if node in times}
        elif index in (self.tpdo.index, self.tpdo.index + MAPPING) and self.state == OPERATIONAL:
            self.tpdo.start(self.now)

    def store(self, key: Key, signature: bytes) -> None:
        """1010h and 1011h: all parameters (1), or those of 1000h to 1FFFh (2). Default values take effect at the next reset."""
        index, sub = key
        if signature != (b"save" if index == STORE else b"load"):
            raise Abort(NOT_STORED)
        keys = [found for found, entry in self.dictionary.entries.items()
                if entry.writable and entry.readable and found[0] not in NOT_STORED_OBJECTS and (sub == 1 or found[0] < 0x2000)]
        for found in keys:
            if index == STORE:
                self.stored[found] = self.dictionary.values[found]
            else:
                self.stored.pop(found, None)
