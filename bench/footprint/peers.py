#!/usr/bin/env python3
"""Rebuilds other stacks with the services of edsc's own node, and prints the figures of both.

    peers.py EDSC RUNTIME_INCLUDE [--canopennode CLONE] [--canopen-stack CLONE] [--update]

CLONE is a git repository of https://github.com/CANopenNode/CANopenNode or https://github.com/embedded-office/canopen-stack; its HEAD is
built in a temporary folder. Services, object dictionary, application, compiler and flags are those of measure.py: peer_nodes/ has the
programs, and for each stack its configuration and driver. First a node must answer the frames of peer_nodes/conversation.cpp as expected.
`--update` writes peers.json, from which measure.py takes the figures of rebuilt stacks.
"""

from __future__ import annotations

import argparse
import binascii
import datetime
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

HERE = Path(__file__).resolve().parent
NODES = HERE / "peer_nodes"
sys.path.insert(0, str(HERE))
import measure  # noqa: E402
import other_stacks  # noqa: E402
from peer_nodes.canopen_stack import dictionary as stack_dictionary  # noqa: E402
from peer_nodes.canopennode import dictionary as node_dictionary  # noqa: E402

ONLY_CPP = {"-std=c++20", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wno-register"}
C_COMPILER = ("arm-none-eabi-gcc", "-std=gnu11", *(flag for flag in measure.COMPILER[1:] if flag not in ONLY_CPP))
DEVICE_NAME = b"CANopen peer bench"  # 1008h of ref.eds, which conversation.cpp uploads as a block
DOWNLOADED = (bytes(range(1, 8)) * 1171)[:8192]  # what transfers.hpp downloads
DEVICES = {"static": measure.STATIC, "dynamic": measure.DYNAMIC, "block": measure.BLOCK}
SIZE_ROWS = {"static": ("flash, static mapping", "RAM, static mapping"),
             "dynamic": ("flash, dynamic mapping", "RAM, dynamic mapping"),
             "block": ("flash, dynamic mapping, block transfer with CRC", None)}


@dataclass(frozen=True)
class Stack:
    """How a stack is built: its folder in peer_nodes, sources in its repository, and the definitions of each variant."""

    name: str
    folder: str
    dictionary: ModuleType
    sources: tuple[str, ...]
    includes: tuple[str, ...]
    variants: dict[str, tuple[str, ...]]


STACKS = {
    "canopennode": Stack(
        "CANopenNode", "canopennode", node_dictionary,
        ("CANopen.c", "301/CO_Emergency.c", "301/CO_NMT_Heartbeat.c", "301/CO_ODinterface.c", "301/CO_PDO.c", "301/CO_SDOserver.c",
         "301/CO_SYNC.c", "301/crc16-ccitt.c"), (".",),
        {"static": (), "dynamic": ("-DPEER_DYNAMIC",),
         "block": ("-DPEER_DYNAMIC", "-DPEER_BLOCK", f"-DPEER_CRC={binascii.crc_hqx(DEVICE_NAME, 0)}",
                   f"-DPEER_DOWNLOAD_CRC={binascii.crc_hqx(DOWNLOADED, 0)}")}),
    "canopen_stack": Stack(
        "canopen-stack", "canopen_stack", stack_dictionary,
        ("src/core/*.c", "src/hal/*.c", "src/object/*/*.c", "src/service/cia301/co_[!c]*.c", "src/config/*.c"),
        ("src/config", "src/core", "src/hal", "src/object/basic", "src/object/cia301", "src/service/cia301", "src/service/cia305"),
        {"dynamic": ("-DPEER_DYNAMIC", "-DUSE_LSS=0", "-DUSE_CSDO=0")}),
}


class Peer:
    """A stack, which is built in a folder."""

    def __init__(self, stack: Stack, bench: measure.Bench, clone: Path, folder: Path):
        self.stack, self.bench, self.clone, self.folder, self.sources = stack, bench, clone, folder, folder / "sources"
        self.sources.mkdir(parents=True)
        archive = subprocess.run(["git", "-C", clone, "archive", "HEAD"], check=True, capture_output=True).stdout
        subprocess.run(["tar", "x", "-C", self.sources], input=archive, check=True)

    def git(self, *command: str) -> str:
        return measure.output("git", "-C", self.clone, *command).strip()

    def dictionary(self, sheet: str) -> Path:
        """Writes OD.h and OD.c for an EDS of measure.py, and returns their folder."""
        made = self.folder / sheet
        if not made.exists():
            made.mkdir()
            eds = made / "device.eds"
            eds.write_text(measure.sheet_text(sheet), encoding="latin-1")
            device = json.loads(measure.output(self.bench.edsc, "dump", eds))
            (made / "OD.h").write_text(self.stack.dictionary.header(device), encoding="utf-8")
            (made / "OD.c").write_text(self.stack.dictionary.source(device), encoding="utf-8")
        return made

    def build(self, program: str, variant: str, sheet: str, flags: Sequence[str]) -> Path:
        made = self.dictionary(sheet)
        objects = self.folder / f"{program}_{variant}_{sheet}_{'_'.join(flags)}"
        objects.mkdir()
        includes = [f"-isystem{self.sources / include}" for include in self.stack.includes]
        options = [*flags, *self.stack.variants[variant], f"-I{NODES / self.stack.folder}", *includes, f"-isystem{made}"]
        linked = []
        for source in (*(path for pattern in self.stack.sources for path in sorted(self.sources.glob(pattern))), made / "OD.c"):
            linked.append(objects / f"{source.stem}.o")
            subprocess.run([*C_COMPILER, *options, "-c", source, "-o", linked[-1]], check=True)
        device = self.bench.headers(measure.FRAME_VARIANTS[variant] if sheet == "bench100" else DEVICES[variant])
        image = objects / "image.elf"
        subprocess.run([*measure.COMPILER, *options, f"-I{self.bench.runtime}", f"-I{device}",
                        NODES / f"{program}.cpp", *linked, "-o", image], check=True)
        return image

    def size(self, variant: str) -> measure.Size:
        """The size of the complete node, without an empty program."""
        whole = measure.size_of(self.build("image", variant, "ref", measure.SMALL))
        return measure.Size(whole.flash - self.bench.empty.flash, whole.ram - self.bench.empty.ram)

    def failed_steps(self, variant: str) -> list[str]:
        """The steps of the conversation in which the node does not send the expected frames."""
        printed = measure.run(self.build("conversation", variant, "ref", measure.SMALL))
        return [step for step, is_passed in ({"end": 0} | printed).items() if not is_passed]

    def instructions(self, variant: str, build: str) -> dict[str, float]:
        return measure.run(self.build("frames", variant, "bench100", measure.COUNTED[build]))


def figures(peer: Peer) -> Iterator[tuple[str, str, float]]:
    """Kind ("bytes" or a build), row and value of each figure."""
    for variant in peer.stack.variants:
        size = peer.size(variant)
        for row, value in zip(SIZE_ROWS[variant], (size.flash, size.ram), strict=True):
            if row is not None:
                yield other_stacks.BYTES, row, value
    for build in measure.COUNTED:
        printed = {variant: peer.instructions(variant, build) for variant in peer.stack.variants}
        for frame in measure.FRAMES:
            found = printed.get(frame.variant) or printed["dynamic"]
            if frame.name in found:
                yield build, frame.what, found[frame.name]


def own_figures(bench: measure.Bench) -> dict[tuple[str, str], float]:
    """edsc's figures of the same run."""
    own = {(other_stacks.BYTES, row.what): row.figure.value for row in measure.sizes(bench)}
    own |= {(build, row.what): figure.value for row in measure.whole_frames(bench) for build, figure in row.figures.items()}
    return own


def report(peer: Peer, own: dict[tuple[str, str], float]) -> dict[str, object]:
    """Prints the figures of a stack, and returns them for peers.json."""
    version = peer.git("describe", "--tags", "--always")
    found: dict[str, dict[str, float]] = {}
    print(f"{peer.stack.name:<66}{'edsc':>8}{version:>20}{'ratio':>8}")
    for kind, row, value in figures(peer):
        found.setdefault(kind, {})[row] = value
        print(f"{kind:<9}{row:<57}{own[kind, row]:8g}{value:20g}{own[kind, row] / value:8.2f}")
    return {"version": version, "commit": peer.git("rev-parse", "HEAD"), "date": datetime.date.today().isoformat(), "figures": found}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("runtime", type=Path)
    for option, stack in STACKS.items():
        parser.add_argument(f"--{option.replace('_', '-')}", type=Path, metavar="CLONE", help=f"a git repository of {stack.name}")
    parser.add_argument("--update", action="store_true", help="write peers.json")
    arguments = parser.parse_args()
    clones = {option: clone for option in STACKS if (clone := getattr(arguments, option)) is not None}
    if not clones:
        parser.error("no repository of a stack")
    with tempfile.TemporaryDirectory() as folder:
        bench = measure.Bench(arguments.edsc.resolve(), arguments.runtime.resolve(), Path(folder))
        peers = [Peer(STACKS[option], bench, clone.resolve(), Path(folder) / option) for option, clone in clones.items()]
        for peer in peers:
            for variant in peer.stack.variants:
                if failed := peer.failed_steps(variant):
                    print(f"{peer.stack.name}, {variant}: the node does not work: {', '.join(failed)}", file=sys.stderr)
                    return 1
        own = own_figures(bench)
        for peer in peers:
            made = report(peer, own)
            if arguments.update:
                other_stacks.update(peer.stack.name, made)
    return 0


if __name__ == "__main__":
    sys.exit(main())
