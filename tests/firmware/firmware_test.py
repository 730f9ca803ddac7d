#!/usr/bin/env python3
"""An image of a reference device on a board of QEMU, over SLCAN on its serial line: boot-up, LSS, all entries and PDOs of its
EDS, stored parameters after a power loss, the stack used, and the same with the commands of edsc.

    firmware_test.py BOARD IMAGE DATA_SHEET NODE_ID EDSC

NODE_ID 0: by LSS.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "masters")]
from data_sheet import DataSheet  # noqa: E402
from host_side import HostSide  # noqa: E402
from machine import STACK_PAINT, Machine  # noqa: E402
from report import Report, read_exceptions  # noqa: E402
from sdo import Abort, Silence  # noqa: E402
from walk import Walk  # noqa: E402

BY_LSS = 9        # the node-ID for a device without one
LARGEST_STACK, OF_DEVICE = 672, {"cpc-tc1": 656}  # bytes; storing parameters needs most
PATIENCE = 10.0   # s, timeout for an expected frame
WHOLE_WALK_ON = "microbit"
SAVE, LOAD = b"save", b"load"
STORE, RESTORE, HEARTBEAT = 0x1010, 0x1011, 0x1017
STORED_TIME = 0x1234  # ms; too long for a heartbeat during the test


class Firmware:
    def __init__(self, machine: Machine, sheet: DataSheet, report: Report) -> None:
        self.machine, self.sheet, self.report = machine, sheet, report

    def check(self, check: str, what: str, got: object, wanted: object) -> bool:
        return self.report.check(check, what, str(got), str(wanted))

    def first_frame(self, seconds: float = PATIENCE) -> str:
        frame = self.wire.bus.recv(seconds)
        return f"{frame.arbitration_id:03X} {frame.data.hex(' ')}" if frame is not None else "nothing"

    def power_on(self) -> None:
        self.machine.power_on()
        self.wire = self.machine.wire()
        self.walk = Walk(self.wire, self.sheet, self.report, tell=lambda _: None, short=self.machine.board != WHOLE_WALK_ON)
        self.sdo = self.walk.sdo

    def power_off(self) -> None:
        self.wire.close()
        self.machine.power_off()

    def boot(self, what: str) -> None:
        """The node has started long before the channel is opened."""
        self.check("boot-up", what, self.first_frame(), f"{0x700 + self.sheet.node_id:03X} 00")

    def lss(self) -> None:
        """CiA 305: configuration state, configure node-ID, store, waiting state; then the node boots. 5E is inquire node-ID."""
        self.check("lss", "silent without node-ID", self.first_frame(1.5), "nothing")
        node_id = f"{BY_LSS:02X}"
        for request, answer in (("04 01", None), (f"11 {node_id}", "11 00 00 00 00 00 00 00"),
                                ("17", "17 00 00 00 00 00 00 00"), ("5E", "5E FF 00 00 00 00 00 00"), ("04 00", None)):
            self.wire.send(0x7E5, bytes.fromhex(request).ljust(8, b"\0"))
            if answer:
                got = self.wire.receive(0x7E4, PATIENCE)
                self.check("lss", request, got and got.hex(" ").upper(), answer)

    def whole_walk(self) -> None:
        """The whole walk on one board; on the others only the parts that depend on their drivers and compilers."""
        walk = self.walk
        long = (walk.refuse_all, walk.download_all, walk.remap, walk.states, walk.guarding, walk.consumer)
        for part in (walk.boot, walk.upload_all, walk.tpdos, walk.rpdos, walk.heartbeat,
                     *(long if self.machine.board == WHOLE_WALK_ON else ())):
            try:
                walk.reset()
                part()
            except (Abort, Silence, ValueError) as problem:
                self.check("walk", part.__name__, problem, "its end")

    def heartbeat_time(self) -> int:
        return int.from_bytes(self.sdo.upload(HEARTBEAT, 0, 2), "little")

    def storage(self) -> None:
        """Stored and restored values remain after a power loss; a device without 1010h loses what was written."""
        self.walk.reset()
        default = self.heartbeat_time()
        stores = self.sheet.get(STORE, 1) is not None
        self.sdo.download(HEARTBEAT, 0, STORED_TIME.to_bytes(2, "little"))
        if stores:
            self.sdo.download(STORE, 1, SAVE)
        self.stack()
        for what, wanted in (("stored", STORED_TIME), ("restored", default)) if stores else (("forgotten", default),):
            self.power_off()
            self.power_on()
            self.boot(what)
            self.check("storage", what, self.heartbeat_time(), wanted)
            if stores:
                self.sdo.download(RESTORE, 1, LOAD)

    def stack(self) -> None:
        """Memory that was painted at power-on and has changed."""
        first, last = self.machine.paint
        memory = self.machine.save(first, last - first, self.machine.folder / "stack")
        untouched = len(memory) - len(memory.lstrip(bytes([STACK_PAINT])))
        used = len(memory) - untouched
        print(f"{self.machine.image.name}: {used} bytes of stack")
        self.machine.image.with_suffix(".stack").write_text(f"{used}\n", encoding="utf-8")  # for bench/footprint/images.py
        largest = OF_DEVICE.get(self.machine.image.stem.rsplit("_", 1)[0], LARGEST_STACK)
        self.check("stack", f"at most {largest} bytes", untouched > 0 and 0 < used <= largest, True)


def memory_for_the_stack(image: Path) -> tuple[int, int]:
    symbols = subprocess.run(["arm-none-eabi-nm", image], check=True, capture_output=True, text=True).stdout
    places = {name: int(address, 16) for address, _, name in map(str.split, symbols.splitlines())}
    return places["__bss_end__"], places["__stack_top__"]


def main() -> int:
    board, image, data_sheet, node_id, edsc = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), int(sys.argv[4]), Path(sys.argv[5])
    sheet = DataSheet(data_sheet, node_id or BY_LSS)
    own = read_exceptions(HERE / "exceptions.tsv")
    report = Report(data_sheet.stem.replace("-", "_"), own + read_exceptions(HERE.parent / "masters/exceptions.tsv"))
    with tempfile.TemporaryDirectory() as folder:
        machine = Machine(board, image, Path(folder), memory_for_the_stack(image))
        try:
            firmware = Firmware(machine, sheet, report)
            firmware.power_on()
            if node_id == 0:
                firmware.lss()
            firmware.boot("power-on")
            firmware.whole_walk()
            firmware.storage()
            firmware.power_off()
            HostSide(edsc, machine, data_sheet, sheet, node_id == 0, report).run()
        finally:
            machine.power_off()
    print(report.summary())
    return 1 if report.failed.total() else 0


if __name__ == "__main__":
    sys.exit(main())
