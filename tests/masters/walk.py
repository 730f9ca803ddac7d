"""A master's walk over one node: tests on the bus everything that the EDS specifies."""

from __future__ import annotations

import statistics
import struct
import time
from collections.abc import Callable
from pathlib import Path

from data_sheet import DOMAIN, DataSheet, Entry
from report import Report, fits, read_rows
from sdo import Abort, SdoClient, Silence
from wire import Wire

START, STOP, PRE_OPERATIONAL, RESET_NODE, RESET_COMMUNICATION = 0x01, 0x02, 0x80, 0x81, 0x82
STATES = {"operational": (START, 0x05), "stopped": (STOP, 0x04), "pre-operational": (PRE_OPERATIONAL, 0x7F)}
GUARD_TIME, LIFE_TIME_FACTOR, CONSUMER_HEARTBEAT, PRODUCER_HEARTBEAT = 0x100C, 0x100D, 0x1016, 0x1017
ERROR_REGISTER, ERROR_HISTORY, EMCY_COB_ID = 0x1001, 0x1003, 0x1014
INVALID, NO_REMOTE_FRAMES = 1 << 31, 1 << 30
HARMLESS = {0x6040: 6, 0x6060: 1, 0x6098: 17}  # values that do not move a drive, and that drives accept
INPUTS = Path(__file__).with_name("inputs.tsv")
PATIENCE = 120.0  # s, for a frame that must be received
SHORT = 0.04    # s, for a frame that must not be received


def hexadecimal(data: bytes) -> str:
    return data.hex(" ").upper()


class Walk:
    def __init__(self, wire: Wire, sheet: DataSheet, report: Report, tell: Callable[[str], None],
                 short: bool = False) -> None:
        self.wire, self.sheet, self.report, self.tell, self.short = wire, sheet, report, tell, short
        self.node_id = sheet.node_id
        self.sdo = SdoClient(wire, self.node_id, PATIENCE)

    def run(self) -> None:
        """Runs all parts. `short`: without the long lists of SDO transfers, and with one PDO of each kind."""
        by_sdo = () if self.short else (self.upload_all, self.refuse_all, self.download_all, self.remap)
        for part in (self.boot, *by_sdo, self.states, self.tpdos, self.rpdos, self.heartbeat, self.guarding, self.consumer,
                     self.emergencies, self.inputs):
            self.wire.listen_to(self.node_id)
            try:
                self.reset()
                part()
            except (Abort, Silence, ValueError) as problem:
                self.report.check("walk", part.__name__, str(problem), "its end")

    # ---- used by all parts ----

    def check(self, check: str, entry: str, got: object, wanted: object) -> bool:
        return self.report.check(check, entry, str(got), str(wanted))

    def nmt(self, command: int, node_id: int | None = None) -> None:
        self.wire.send(0x000, bytes([command, self.node_id if node_id is None else node_id]))

    def reset(self, command: int = RESET_NODE) -> None:
        self.wire.forget()
        self.nmt(command)
        told = self.state(0)
        self.check("boot-up", "reset", "nothing" if told is None else f"{told:02X}", "00")
        self.wire.forget()

    def upload(self, entry: Entry) -> bytes:
        return self.sdo.upload(entry.index, entry.sub, entry.size)

    def read(self, index: int, sub: int = 0) -> int:
        return int.from_bytes(self.upload(self.sheet.get(index, sub)), "little")

    def write(self, index: int, sub: int, value: int) -> None:
        entry = self.sheet.get(index, sub)
        self.sdo.download(index, sub, entry.bytes_of(value))

    def outcome(self, action: Callable[[], bytes | None]) -> str:
        """Returns the result of an SDO transfer."""
        try:
            data = action()
        except (Abort, Silence, ValueError) as problem:
            return str(problem)
        return "taken" if data is None else f"reads {hexadecimal(data)}"

    def emcy(self, seconds: float = PATIENCE) -> str:
        frame = self.wire.receive(0x80 + self.node_id, seconds)
        return hexadecimal(frame) if frame is not None else "nothing"

    def expect_emcy(self, code: int, register: int | None = None, after: str = "") -> None:
        """Expects an EMCY with this code; without an exception bytes 3 to 7 are 0."""
        got = self.emcy()
        if not self.check("emcy", after or f"{code:04X}h:00", got[:5], hexadecimal(struct.pack("<H", code))):
            return
        if register is not None:
            self.check("emcy-register", after or f"{code:04X}h:00", got[6:8], f"{register:02X}")
        if after:
            return
        self.check("emcy-info", f"{code:04X}h:00", got[9:], "00 00 00 00 00")

    # ---- boot-up and the object dictionary ----

    def boot(self) -> None:
        self.reset(RESET_COMMUNICATION)
        self.nmt(RESET_NODE, 127)
        got = self.wire.receive(0x700 + self.node_id, SHORT)
        self.check("boot-up", "reset of another node", got, None)

    def upload_all(self) -> None:
        for entry in self.sheet.entries.values():
            check = "default" if entry.readable else "write-only"
            if self.report.skips(entry.name, check):
                continue
            got = self.outcome(lambda: self.upload(entry))
            if not entry.readable:
                wanted = "abort 06010001"
            elif entry.default is not None:
                wanted = f"reads {hexadecimal(entry.default)}"
            else:  # no default: any value of the right length
                fits = entry.size is None or len(got) == len("reads") + 3 * entry.size
                wanted = got if got.startswith("reads") and fits else f"reads {entry.size} bytes"
            self.check(check, entry.name, got, wanted)

    def refuse_all(self) -> None:
        """Accesses objects and sub-indices that do not exist."""
        indices = sorted({index for index, _ in self.sheet.entries})
        for index in indices:
            sub = max(self.sheet.subs(index)) + 1
            if index != ERROR_HISTORY and sub <= 0xFF:
                got = self.outcome(lambda: self.sdo.upload(index, sub))
                self.check("no-entry", f"{index:04X}h:{sub:02X}", got, "abort 06090011")
        for index in {index + 1 for index in indices if index < 0xFFFF} - set(indices):
            got = self.outcome(lambda: self.sdo.upload(index, 0))
            self.check("no-object", f"{index:04X}h:00", got, "abort 06020000")

    def download_all(self) -> None:
        for entry in self.sheet.entries.values():
            if entry.type == DOMAIN or entry.size is None or not entry.writable:
                self.write_read_only(entry)
                continue
            before = self.upload(entry) if entry.readable else entry.default
            low, high = entry.range_of_type()
            at_low, at_high = entry.low if entry.low is not None else low, entry.high if entry.high is not None else high
            trials = [("low", entry.bytes_of(at_low), "taken"), ("high", entry.bytes_of(at_high), "taken")]
            if at_low > low:
                trials.append(("below", entry.bytes_of(at_low - 1), "abort 06090032"))
            if at_high < high:
                trials.append(("above", entry.bytes_of(at_high + 1), "abort 06090031"))
            trials.append(("long", entry.bytes_of(at_low) + b"\0", "abort 06070012"))
            if entry.size > 1:
                trials.append(("short", entry.bytes_of(at_low)[:-1], "abort 06070013"))
            for check, data, wanted in trials:
                if not self.report.skips(entry.name, check):
                    self.write_and_read(entry, check, data, wanted)
            if before is not None and not self.report.skips(entry.name, "restore"):
                self.write_and_read(entry, "restore", before, "taken")

    def write_and_read(self, entry: Entry, check: str, data: bytes, wanted: str) -> None:
        got = self.outcome(lambda: self.sdo.download(entry.index, entry.sub, data))
        if got == "taken" and entry.readable:
            back = self.outcome(lambda: self.upload(entry))
            got = "taken" if back == f"reads {hexadecimal(data)}" else f"taken, {back}"
        self.check(check, entry.name, got, wanted)

    def write_read_only(self, entry: Entry) -> None:
        if self.report.skips(entry.name, "read-only"):
            return
        got = self.outcome(lambda: self.sdo.download(entry.index, entry.sub, bytes(entry.size or 1)))
        self.check("read-only", entry.name, got, "abort 06010002")

    # ---- parameters of PDOs ----

    def remap(self) -> None:
        """CiA 301, 7.5.2.36: make a PDO invalid, write 0 to sub-index 0 of its mapping, write the entries and their number, and
        make the PDO valid again."""
        for index in self.pdos(0x1400) + self.pdos(0x1800):
            mapping, default = index + 0x200, self.read(index, 1)
            free, other = 0x6A0 + self.node_id, 0x680 + self.node_id  # unused CAN-IDs
            cob_id = default if default & 0x7FF else default | free
            dynamic = self.sheet.get(mapping, 0) is not None and self.sheet.get(mapping, 0).writable
            entries = [self.read(mapping, sub) for sub in range(1, self.read(mapping) + 1)]
            self.set("valid", index, 1, cob_id & ~INVALID)
            if dynamic:
                self.set("mapping-valid", mapping, 0, 0, "abort 06010000")
            self.set("cob-id-valid", index, 1, cob_id & ~(INVALID | 0x7FF) | other, "abort 06090030")
            self.set("invalid", index, 1, cob_id | INVALID)
            self.set("cob-id", index, 1, cob_id & ~0x7FF | INVALID | other)
            self.set("cob-id-restricted", index, 1, cob_id & ~(INVALID | 0x7FF) | 0x601, "abort 06090030")
            self.set("cob-id-29-bits", index, 1, cob_id & ~INVALID | 1 << 29, "abort 06090030")
            self.set("invalid", index, 1, cob_id | INVALID)
            self.set("reserved-type", index, 2, 245, "abort 06090030")
            self.set("type", index, 2, 1)
            if index >= 0x1800:
                self.set("inhibit-time", index, 3, 100)
            if dynamic:
                self.map_anew(mapping, entries)
            self.set("invalid", index, 1, cob_id | INVALID)
            self.set("valid", index, 1, default)

    def map_anew(self, mapping: int, entries: list[int]) -> None:
        room = max(self.sheet.subs(mapping))
        self.set("mapping", mapping, 0, 0)
        self.set("unmappable", mapping, 1, 0x1000_0020, "abort 06040041")
        self.set("mapping-no-object", mapping, 1, 0x5FFF_0020, "abort 06040041")
        if entries and (count := 64 // (entries[0] & 0xFF) + 1) <= room:
            for sub in range(1, count + 1):
                self.set("mapping", mapping, sub, entries[0])
            self.set("mapping-too-long", mapping, 0, count, "abort 06040042")
        for sub, entry in enumerate(entries, 1):
            self.set("mapping", mapping, sub, entry)
        self.set("mapping", mapping, 0, len(entries))

    def set(self, check: str, index: int, sub: int, value: int, wanted: str = "taken") -> None:
        """Writes a parameter if the EDS has it and it is writable."""
        entry = self.sheet.get(index, sub)
        if entry is not None and entry.writable and not self.report.skips(entry.name, check):
            self.write_and_read(entry, check, entry.bytes_of(value), wanted)

    # ---- NMT ----

    def served(self, seconds: float) -> bool:
        self.wire.forget(0x580 + self.node_id)
        self.wire.send(0x600 + self.node_id, struct.pack("<BHBI", 0x40, 0x1000, 0, 0))
        return self.wire.receive(0x580 + self.node_id, seconds) is not None

    def state(self, wanted: int) -> int | None:
        """Returns the wanted state when a heartbeat contains it, otherwise the last received state."""
        state, end = None, time.monotonic() + PATIENCE
        while time.monotonic() < end:  # the first frames may be older than the command
            frame = self.wire.receive(0x700 + self.node_id, PATIENCE)
            if frame is None:
                break
            state = frame[0]
            if state == wanted:
                break
        return state

    def change_state(self, when: str, command: int, wanted: int) -> None:
        self.wire.forget(0x700 + self.node_id)
        self.nmt(command)
        self.check("nmt", when, self.state(wanted), wanted)

    def stay_in_state(self, when: str, wanted: int) -> None:
        self.wire.forget(0x700 + self.node_id)
        beats = {self.wire.receive(0x700 + self.node_id, PATIENCE) for _ in range(3)}
        self.check("nmt", when, beats, {bytes([wanted])})

    def states(self) -> None:
        self.wire.listen_to(self.node_id, pdos=False)
        self.write(PRODUCER_HEARTBEAT, 0, 10)
        self.stay_in_state("after boot-up", 0x7F)
        names = list(STATES)
        for name in [one for first in names for second in names for one in (first, second)]:
            command, number = STATES[name]
            self.change_state(name, command, number)
            served = self.served(SHORT if name == "stopped" else PATIENCE)
            self.check("nmt", f"SDO in {name}", served, name != "stopped")
        self.nmt(START, 127)
        self.stay_in_state("command to another node", 0x7F)
        self.wire.send(0x000, bytes([START]))
        self.stay_in_state("command of one byte", 0x7F)
        for command in (RESET_COMMUNICATION, RESET_NODE):
            for name in STATES:
                self.write(PRODUCER_HEARTBEAT, 0, 0)
                self.nmt(STATES[name][0])
                self.reset(command)
                self.check("nmt", f"heartbeat time after command {command:02X}h", self.read(PRODUCER_HEARTBEAT), 0)

    # ---- PDOs ----

    def mapping(self, parameter: int) -> list[Entry]:
        """Reads the mapping of a PDO with this communication parameter over SDO."""
        mapped = parameter + 0x200
        entries = []
        for sub in range(1, self.read(mapped) + 1):
            value = self.read(mapped, sub)
            entries.append(self.sheet.entries.get((value >> 16, value >> 8 & 0xFF)))
        return entries

    def pdos(self, first: int) -> list[int]:
        return sorted({index for index, _ in self.sheet.entries if first <= index < first + 0x200})

    def try_write(self, index: int, sub: int, value: int) -> bool:
        entry = self.sheet.get(index, sub)
        if entry is None or not entry.writable:
            return False
        try:
            self.write(index, sub, value)
        except Abort:
            return False
        return True

    def tpdos(self) -> None:
        for index in self.pdos(0x1800):
            entries = self.mapping(index)
            cob_id = self.read(index, 1)
            can_id, name = cob_id & 0x7FF, f"{index:04X}h:01"
            if not entries or can_id == 0 or self.report.skips(name, "tpdo"):
                continue
            self.nmt(PRE_OPERATIONAL)
            self.try_write(index, 1, cob_id | INVALID)
            by_sync = self.try_write(index, 2, 1)
            self.try_write(index, 1, cob_id & ~INVALID)
            self.wire.forget(can_id)
            self.wire.send(0x080)
            self.check("tpdo", f"{name} in Pre-operational", self.wire.receive(can_id, SHORT), None)
            self.write(PRODUCER_HEARTBEAT, 0, 10)
            self.nmt(START)
            if by_sync:
                self.wire.receive(can_id, SHORT)
                self.wire.send(0x080)
                self.tpdo_content(name, "sync", can_id, entries)
                self.wire.send(0x080)
                self.tpdo_content(name, "sync", can_id, entries)
            self.remote_tpdo(index, name, cob_id, entries)
            self.timed_tpdo(index, name, cob_id, entries)
            self.change_state(f"TPDO {name}", STOP, STATES["stopped"][1])  # what it sent before has been received
            self.wire.forget(can_id)
            self.wire.send(0x080)
            self.check("tpdo", f"{name} in Stopped", self.wire.receive(can_id, SHORT), None)
            self.reset()
            if self.short:
                break

    def tpdo_content(self, name: str, how: str, can_id: int, entries: list[Entry], seconds: float = PATIENCE) -> None:
        frame = self.wire.receive(can_id, seconds)
        size = sum(entry.size for entry in entries)
        if not self.check("tpdo", f"{name} by {how}", "nothing" if frame is None else len(frame), size):
            return
        at = 0
        for entry in entries:
            part, at = frame[at:at + entry.size], at + entry.size
            value = self.upload(entry) if entry.readable else part
            self.check("tpdo-value", entry.name, hexadecimal(part), hexadecimal(value))

    def remote_tpdo(self, index: int, name: str, cob_id: int, entries: list[Entry]) -> None:
        """Type 253, if supported: the TPDO is sent after a remote frame, unless bit 30 is set."""
        self.nmt(PRE_OPERATIONAL)
        self.try_write(index, 1, cob_id | INVALID)
        by_request = self.try_write(index, 2, 253)
        self.try_write(index, 1, cob_id & ~INVALID)
        self.nmt(START)
        if not by_request:
            return
        self.wire.forget(cob_id & 0x7FF)
        self.wire.request(cob_id & 0x7FF, sum(entry.size for entry in entries))
        if cob_id & NO_REMOTE_FRAMES:
            self.check("tpdo", f"{name} by a remote frame", self.wire.receive(cob_id & 0x7FF, SHORT), None)
        else:
            self.tpdo_content(name, "remote frame", cob_id & 0x7FF, entries)

    def timed_tpdo(self, index: int, name: str, cob_id: int, entries: list[Entry]) -> None:
        self.nmt(PRE_OPERATIONAL)
        self.try_write(index, 1, cob_id | INVALID)
        if not self.try_write(index, 2, 254) and self.read(index, 2) < 254:
            return
        timed = self.try_write(index, 5, 20)
        self.try_write(index, 1, cob_id & ~INVALID)
        self.nmt(START)
        if not timed:
            return
        self.wire.forget(cob_id & 0x7FF)
        for _ in range(3):
            self.tpdo_content(name, "event timer", cob_id & 0x7FF, entries)

    def rpdos(self) -> None:
        for index in self.pdos(0x1400):
            entries = self.mapping(index)
            cob_id = self.read(index, 1)
            can_id, name = cob_id & 0x7FF, f"{index:04X}h:01"
            if not entries or can_id == 0 or None in entries or self.report.skips(name, "rpdo"):
                continue
            self.try_write(index, 1, cob_id & ~INVALID)
            values = [self.rpdo_value(entry) for entry in entries]
            frame = b"".join(values)
            before = [self.upload(entry) for entry in entries]
            self.wire.send(can_id, frame)
            for entry, value in zip(entries, before):
                got = self.upload(entry)
                self.check("rpdo", f"{entry.name} in Pre-operational", hexadecimal(got), hexadecimal(value))
            self.nmt(START)
            self.wire.send(can_id, frame + b"\xA5" * (len(frame) < 8))
            for entry, value in zip(entries, values):
                got = self.upload(entry)
                self.check("rpdo-value", entry.name, hexadecimal(got), hexadecimal(value))
            self.reset()
            if self.short:
                break

    def rpdo_value(self, entry: Entry) -> bytes:
        """Returns a value within the limits that does not move a drive."""
        if entry.index in HARMLESS:
            return entry.bytes_of(HARMLESS[entry.index])
        low, high = entry.range_of_type()
        low, high = entry.low if entry.low is not None else low, entry.high if entry.high is not None else high
        return entry.bytes_of(min(max(0x35, low), high))

    # ---- error control ----

    def heartbeat(self) -> None:
        for milliseconds in (20, 50):
            self.write(PRODUCER_HEARTBEAT, 0, milliseconds)
            for _ in range(100):  # on a busy machine some measurements fail; a wrong period always does
                interval = self.heartbeat_interval()
                if 0.7 * milliseconds <= interval <= 1.3 * milliseconds + 3:
                    interval = milliseconds
                    break
            self.check("heartbeat", f"{milliseconds} ms", f"every {interval:.1f} ms", f"every {milliseconds:.1f} ms")
        self.write(PRODUCER_HEARTBEAT, 0, 0)
        self.wire.forget(0x700 + self.node_id)
        self.check("heartbeat", "switched off", self.wire.receive(0x700 + self.node_id, 0.08), None)

    def heartbeat_interval(self) -> float:
        """Returns the median of four intervals in ms."""
        self.wire.forget(0x700 + self.node_id)
        beats = [self.wire.receive_timed(0x700 + self.node_id, PATIENCE) for _ in range(5)]
        if None in beats:
            raise Silence
        times = [at for at, _ in beats]
        self.check("heartbeat", "bytes", {data for _, data in beats}, {b"\x7f"})
        return statistics.median(after - before for before, after in zip(times, times[1:])) * 1000

    def guard(self, seconds: float = PATIENCE) -> str:
        self.wire.request(0x700 + self.node_id, 1)
        frame = self.wire.receive(0x700 + self.node_id, seconds)
        return hexadecimal(frame) if frame is not None else "nothing"

    def guarding(self) -> None:
        if self.sheet.get(GUARD_TIME) is None:
            self.check("guarding", "without 100Ch", self.guard(SHORT), "nothing")
            return
        self.check("guarding", "first", self.guard(), "7F")
        self.check("guarding", "second", self.guard(), "FF")
        self.nmt(START)
        self.check("guarding", "operational", self.guard(), "05")
        self.nmt(STOP)
        self.check("guarding", "stopped", self.guard(), "84")
        self.reset(RESET_COMMUNICATION)
        self.check("guarding", "after reset communication", self.guard(), "7F")
        if self.sheet.get(EMCY_COB_ID) is None or self.report.skips("100Ch:00", "life-guarding"):
            return
        self.write(GUARD_TIME, 0, 20)
        self.write(LIFE_TIME_FACTOR, 0, 3)
        self.check("guarding", "before life guarding", self.guard(), "FF")
        self.expect_emcy(0x8130)
        self.check("guarding", "after it was lost", self.guard(), "7F")
        self.expect_emcy(0x0000)
        self.write(GUARD_TIME, 0, 0)

    def consumer(self) -> None:
        entry = self.sheet.get(CONSUMER_HEARTBEAT, 1)
        if entry is None or not entry.writable:
            return
        self.write(PRODUCER_HEARTBEAT, 0, 10)
        self.write(CONSUMER_HEARTBEAT, 1, 126 << 16 | 50)
        self.nmt(START)
        self.check("consumer", "before the first heartbeat", self.emcy(0.1), "nothing")
        self.wire.send(0x77E, b"\x05")
        self.expect_emcy(0x8130)
        self.stay_in_state("when a heartbeat is lost", 0x7F)
        self.wire.send(0x77E, b"\x05")
        self.expect_emcy(0x0000)

    # ---- emergencies ----

    def emergencies(self) -> None:
        for index in self.pdos(0x1400):
            cob_id, entries = self.read(index, 1), self.mapping(index)
            if cob_id & INVALID or not entries or None in entries or self.sheet.get(EMCY_COB_ID) is None:
                continue
            frame = b"".join(self.rpdo_value(entry) for entry in entries)
            self.nmt(START)
            errors = self.read(ERROR_HISTORY) if self.sheet.get(ERROR_HISTORY) else 0  # a device may keep them over a reset
            self.wire.send(cob_id & 0x7FF, frame[:-1])
            self.expect_emcy(0x8210, 0x11)
            self.check("emcy", "1001h", f"{self.read(ERROR_REGISTER):02X}", "11")
            if self.sheet.get(ERROR_HISTORY):
                places = max(self.sheet.subs(ERROR_HISTORY))
                self.check("emcy", "1003h:00", self.read(ERROR_HISTORY), min(errors + 1, places))
                self.check("emcy", "1003h:01", f"{self.read(ERROR_HISTORY, 1) & 0xFFFF:04X}", "8210")
            self.wire.send(cob_id & 0x7FF, frame[:-1])
            self.check("emcy", "the same again", self.emcy(SHORT), "nothing")
            self.wire.send(cob_id & 0x7FF, frame)
            self.expect_emcy(0x0000, 0x00)
            if self.sheet.get(ERROR_HISTORY) and self.sheet.get(ERROR_HISTORY).writable:
                self.write(ERROR_HISTORY, 0, 0)
                self.check("emcy", "1003h:00 cleared", self.read(ERROR_HISTORY), 0)
            return

    def inputs(self) -> None:
        """Expects the EMCYs that the node's simulated inputs cause."""
        for _, (devices, line, code, register) in read_rows(INPUTS):
            if fits(devices, self.report.device):
                self.tell(line)
                self.expect_emcy(int(code, 16), int(register, 16), line)
