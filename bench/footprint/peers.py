#!/usr/bin/env python3
"""Rebuilds CANopenNode with the services of edsc's own node, and prints the figures of both.

    peers.py EDSC RUNTIME_INCLUDE --canopennode CLONE [--update]

CLONE is a git repository of https://github.com/CANopenNode/CANopenNode; its HEAD is built in a temporary folder. Services, object
dictionary, application, compiler and flags are those of measure.py: canopennode/ has the configuration, the driver and the programs.
First the node must answer the frames of canopennode/conversation.cpp as expected. `--update` writes peers.json, from which
measure.py takes the figures of rebuilt stacks.
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
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import measure  # noqa: E402
import other_stacks  # noqa: E402
from canopennode import dictionary  # noqa: E402

STACK = "CANopenNode"
SOURCES = ("CANopen", "301/CO_Emergency", "301/CO_NMT_Heartbeat", "301/CO_ODinterface", "301/CO_PDO", "301/CO_SDOserver",
           "301/CO_SYNC", "301/crc16-ccitt")
ONLY_CPP = {"-std=c++20", "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Wno-register"}
C_COMPILER = ("arm-none-eabi-gcc", "-std=gnu11", *(flag for flag in measure.COMPILER[1:] if flag not in ONLY_CPP))
DEVICE_NAME = b"CANopen peer bench"  # 1008h of ref.eds, which conversation.cpp uploads as a block
DEFINITIONS = {"static": (), "dynamic": ("-DPEER_DYNAMIC",),
               "block": ("-DPEER_DYNAMIC", "-DPEER_BLOCK", f"-DPEER_CRC={binascii.crc_hqx(DEVICE_NAME, 0)}")}
DEVICES = {"static": measure.STATIC, "dynamic": measure.DYNAMIC, "block": measure.BLOCK}
SIZE_ROWS = {"static": ("flash, static mapping", "RAM, static mapping"),
             "dynamic": ("flash, dynamic mapping", "RAM, dynamic mapping"),
             "block": ("flash, dynamic mapping, block transfer with CRC", None)}


class Peer:
    """CANopenNode, which is built in a folder."""

    def __init__(self, bench: measure.Bench, clone: Path, folder: Path):
        self.bench, self.clone, self.folder, self.sources = bench, clone, folder, folder / "sources"
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
            (made / "OD.h").write_text(dictionary.header(device), encoding="utf-8")
            (made / "OD.c").write_text(dictionary.source(device), encoding="utf-8")
        return made

    def build(self, program: str, variant: str, sheet: str, flags: Sequence[str]) -> Path:
        made = self.dictionary(sheet)
        objects = self.folder / f"{program}_{variant}_{sheet}_{'_'.join(flags)}"
        objects.mkdir()
        options = [*flags, *DEFINITIONS[variant], f"-I{HERE / 'canopennode'}", f"-isystem{self.sources}", f"-isystem{made}"]
        linked = []
        for source in (*(self.sources / f"{name}.c" for name in SOURCES), made / "OD.c"):
            linked.append(objects / f"{source.stem}.o")
            subprocess.run([*C_COMPILER, *options, "-c", source, "-o", linked[-1]], check=True)
        device = self.bench.headers(measure.FRAME_VARIANTS[variant] if sheet == "bench100" else DEVICES[variant])
        image = objects / "image.elf"
        subprocess.run([*measure.COMPILER, *options, f"-I{self.bench.runtime}", f"-I{device}",
                        HERE / f"canopennode/{program}.cpp", *linked, "-o", image], check=True)
        return image

    def size(self, variant: str) -> measure.Size:
        """The size of the complete node, without an empty program."""
        whole = measure.size_of(self.build("image", variant, "ref", measure.SMALL))
        return measure.Size(whole.flash - self.bench.empty.flash, whole.ram - self.bench.empty.ram)

    def failed_steps(self, variant: str) -> list[str]:
        """The steps of the conversation in which the node does not send the expected frames."""
        printed = measure.run(self.build("conversation", variant, "ref", measure.SMALL))
        return [step for step, is_passed in printed.items() if not is_passed] if printed else ["start"]

    def instructions(self, variant: str, build: str) -> dict[str, float]:
        return measure.run(self.build("frames", variant, "bench100", measure.COUNTED[build]))


def figures(peer: Peer) -> Iterator[tuple[str, str, float]]:
    """Kind ("bytes" or a build), row and value of each figure."""
    for variant, rows in SIZE_ROWS.items():
        size = peer.size(variant)
        for row, value in zip(rows, (size.flash, size.ram), strict=True):
            if row is not None:
                yield other_stacks.BYTES, row, value
    for build in measure.COUNTED:
        printed = {variant: peer.instructions(variant, build) for variant in DEFINITIONS}
        for frame in measure.FRAMES:
            if frame.name in printed[frame.variant]:
                yield build, frame.what, printed[frame.variant][frame.name]


def own_figures(bench: measure.Bench) -> dict[tuple[str, str], float]:
    """edsc's figures of the same run."""
    own = {(other_stacks.BYTES, row.what): row.figure.value for row in measure.sizes(bench)}
    own |= {(build, row.what): figure.value for row in measure.whole_frames(bench) for build, figure in row.figures.items()}
    return own


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("runtime", type=Path)
    parser.add_argument("--canopennode", type=Path, required=True, metavar="CLONE", help="a git repository of CANopenNode")
    parser.add_argument("--update", action="store_true", help="write peers.json")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = measure.Bench(arguments.edsc.resolve(), arguments.runtime.resolve(), Path(folder))
        peer = Peer(bench, arguments.canopennode.resolve(), Path(folder) / "canopennode")
        for variant in DEFINITIONS:
            if failed := peer.failed_steps(variant):
                print(f"{STACK}, {variant}: the node does not work: {', '.join(failed)}", file=sys.stderr)
                return 1
        version, own = peer.git("describe", "--tags", "--always"), own_figures(bench)
        found: dict[str, dict[str, float]] = {}
        print(f"{'':<66}{'edsc':>8}{version:>20}{'ratio':>8}")
        for kind, row, value in figures(peer):
            found.setdefault(kind, {})[row] = value
            print(f"{kind:<9}{row:<57}{own[kind, row]:8g}{value:20g}{own[kind, row] / value:8.2f}")
        if arguments.update:
            other_stacks.update(STACK, {"version": version, "commit": peer.git("rev-parse", "HEAD"),
                                        "date": datetime.date.today().isoformat(), "figures": found})
    return 0


if __name__ == "__main__":
    sys.exit(main())
