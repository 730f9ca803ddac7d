"""A board of QEMU with an image. Its serial line is a pseudo-terminal of the host."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "masters"))
from wire import Wire  # noqa: E402

PAGES = 4 * 2048  # bytes: two pairs of pages of board::Flash


def connected(path: Path) -> socket.socket:
    """Connects to a socket that QEMU is about to create."""
    end = time.monotonic() + 60
    while not path.exists() and time.monotonic() < end:
        time.sleep(0.01)
    line = socket.socket(socket.AF_UNIX)
    line.connect(str(path))
    return line


def write_memory(line: socket.socket, address: int, data: bytes) -> None:
    """Writes memory by the remote protocol of GDB, which can also write flash."""
    for at in range(0, len(data), 1024):
        piece = data[at:at + 1024]
        packet = f"M{address + at:x},{len(piece):x}:{piece.hex()}".encode()
        line.sendall(b"$" + packet + f"#{sum(packet) % 256:02x}".encode())
        answer = b""
        while b"#" not in answer[:-2]:
            answer += line.recv(64)
        if b"$OK#" not in answer:
            raise RuntimeError(f"memory at {address + at:#x} cannot be written: {answer!r}")
        line.sendall(b"+")


@dataclass(frozen=True)
class Board:
    pages: int  # address of board::Flash


BOARDS = {
    "microbit": Board(0x0003_E000),
    "mps2-an385": Board(0x2100_0000),
    "mps2-an386": Board(0x2100_0000),
}
STACK_PAINT = 0xA5


class Machine:
    """The flash pages are a file in `folder`: erased at first, loaded at power-on and saved before power-off. All other memory
    is lost in between."""

    def __init__(self, board: str, image: Path, folder: Path, paint: tuple[int, int] | None = None) -> None:
        """`paint`: start and end of the memory that is filled with STACK_PAINT at power-on."""
        self.board, self.image, self.folder, self.paint = board, image, folder, paint
        self.flash = folder / "flash"
        self.process: subprocess.Popen[str] | None = None
        self.erase()

    def erase(self) -> None:
        self.flash.write_bytes(b"\xff" * PAGES)

    def power_on(self) -> None:
        control = self.folder / "control"
        control.unlink(missing_ok=True)
        debugger = self.folder / "debugger"
        debugger.unlink(missing_ok=True)
        self.process = subprocess.Popen(
            ["qemu-system-arm", "-M", self.board, "-kernel", self.image, "-display", "none", "-monitor", "none", "-serial", "pty",
             "-S", "-gdb", f"unix:{debugger},server=on,wait=off", "-qmp", f"unix:{control},server=on,wait=off"],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True)
        told = self.process.stdout.readline()
        match = re.search(r"/dev/pts/\d+", told)
        if not match:
            raise RuntimeError(f"qemu-system-arm: {told}{self.process.stdout.read()}")
        self.address = f"slcan:{match[0]}"
        self.line = os.open(match[0], os.O_RDWR | os.O_NOCTTY)  # QEMU checks only once a second for a host that reconnects
        self.control = connected(control)
        self.lines = self.control.makefile("rw")
        self.lines.readline()
        self.command("qmp_capabilities")
        with connected(debugger) as line:
            write_memory(line, BOARDS[self.board].pages, self.flash.read_bytes())
            if self.paint:
                first, last = self.paint
                write_memory(line, first, bytes([STACK_PAINT]) * (last - first))
        self.command("cont")

    def command(self, name: str, **arguments: object) -> None:
        self.lines.write(json.dumps({"execute": name, "arguments": arguments}) + "\n")
        self.lines.flush()
        while "return" not in (answer := json.loads(self.lines.readline())):
            if "error" in answer:
                raise RuntimeError(f"{name}: {answer['error']}")

    def save(self, address: int, size: int, to: Path) -> bytes:
        """Returns the content of its memory."""
        self.command("memsave", val=address, size=size, filename=str(to), **{"cpu-index": 0})
        return to.read_bytes()

    def power_off(self) -> None:
        if self.process is None:
            return
        if self.process.poll() is None:
            self.command("stop")
            self.save(BOARDS[self.board].pages, PAGES, self.flash)
            self.process.kill()
        self.control.close()
        os.close(self.line)
        self.process.wait()
        self.process.stdout.close()
        self.process = None

    def wire(self) -> Wire:
        return Wire(self.address)
