#!/usr/bin/env python3
"""A DBC parser without edsc's code decodes frames of the reference devices to the values and names of `edsc dump`.

    dbc_decode_test.py SOURCE_DIR EDSC

The parser is canmatrix. It decodes 5,000 random frames of each device; each signal is compared with the value, unit and name
that the dump gives for its bits.
"""

from __future__ import annotations

import logging
import random
import subprocess
import sys
import tempfile
import warnings
from fractions import Fraction
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from dbc_signals import INVALID, Message, Signal, dump_of, messages_of, sheet_mapping  # noqa: E402

logging.disable(logging.CRITICAL)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import canmatrix
    import canmatrix.formats

NODE_ID = 5
FRAMES = 5000
TOLERANCE = Fraction(1, 10**14)  # a factor such as 4/13107 is not a finite decimal


def is_near(found: Fraction, expected: Fraction) -> bool:
    return abs(found - expected) <= abs(expected) * TOLERANCE


def is_same(decoded: object, signal: Signal, frame: int) -> bool:
    if signal.real:
        return True  # a real number is compared by its bits only, which may be those of no number
    raw, physical = Fraction(decoded.raw_value), Fraction(decoded.phys_value)
    name = signal.names.get(signal.number(frame))
    named = decoded.named_value
    return raw == signal.number(frame) and is_near(physical, signal.physical(frame)) and (named == name if name else named == decoded.phys_value)


def long_name(one: object, attribute: str) -> str:
    return str(one.attributes.get(attribute, one.name))


def compare_frame(found: object, message: Message, random_bytes: bytes, problems: list[str]) -> int:
    frame = int.from_bytes(random_bytes, "little")
    decoded = found.decode(random_bytes)
    by_place = {signal.start_bit: signal.name for signal in found.signals}
    for signal in message.signals:
        name = by_place.get(signal.start)
        if name is None or not is_same(decoded[name], signal, frame):
            problems.append(f"{found.name} {random_bytes.hex()}: {signal.name} is {signal.physical(frame)}, "
                            f"{signal.names.get(signal.number(frame))}; decoded {decoded.get(name)}")
    return len(message.signals)


def compare_names(found: object, message: Message, problems: list[str]) -> None:
    names = [(long_name(one, "SystemSignalLongSymbol"), one.start_bit, one.size, one.unit) for one in
             sorted(found.signals, key=lambda one: one.start_bit)]
    expected = [(one.name, one.start, one.bits, one.unit) for one in sorted(message.signals, key=lambda one: one.start)]
    if names != expected:
        problems.append(f"{found.name}: expected the signals {expected}, got {names}")


def compare_device(path: Path, edsc: str, file: Path, problems: list[str]) -> int:
    subprocess.run([edsc, "generate", path, "--options", path.with_suffix(".options.json"), "--node-id", str(NODE_ID),
                    "--dbc", file], check=True, stderr=subprocess.DEVNULL)
    matrix, = canmatrix.formats.loadp(str(file), dbcImportEncoding="cp1252").values()
    expected = {message.number: message for message in messages_of(dump_of(edsc, path, NODE_ID))}
    found = {one.arbitration_id.id | (INVALID if one.arbitration_id.extended else 0): one for one in matrix.frames}
    if expected.keys() != found.keys() or not expected:
        problems.append(f"{path.stem}: expected the messages {sorted(expected)}, got {sorted(found)}")
        return 0
    for number, message in expected.items():
        compare_names(found[number], message, problems)
    numbers = random.Random(path.stem)
    usable = [number for number, message in expected.items() if message.signals]
    count = 0
    for _ in range(FRAMES):
        number = numbers.choice(usable)
        count += compare_frame(found[number], expected[number], numbers.randbytes(expected[number].length), problems)
    return count


def check_mapped_twice(edsc: str, folder: Path, problems: list[str]) -> None:
    """Each signal of an object that a PDO maps twice has its own name and bits, whether the name is short or shortened."""
    long = "temperature of the second winding of the motor"
    sheet, file = folder / "twice.eds", folder / "twice.dbc"
    sheet.write_text(sheet_mapping(["speed", long, "speed", long]))
    subprocess.run([edsc, "generate", sheet, "--node-id", str(NODE_ID), "--dbc", file], check=True, stderr=subprocess.DEVNULL)
    matrix, = canmatrix.formats.loadp(str(file), dbcImportEncoding="cp1252").values()
    name = long.replace(" ", "_")
    found = [(long_name(one, "SystemSignalLongSymbol"), one.start_bit) for one in sorted(matrix.frames[0].signals, key=lambda one: one.start_bit)]
    if found != [("speed", 0), (name, 8), ("speed_2", 16), (f"{name}_2", 24)]:
        problems.append(f"an object that is mapped twice: {found}")
    decoded = matrix.frames[0].decode(bytes([1, 2, 3, 4]))
    if sorted(int(one.raw_value) for one in decoded.values()) != [1, 2, 3, 4]:
        problems.append(f"an object that is mapped twice: {decoded}")


def main() -> int:
    source, edsc = Path(sys.argv[1]), sys.argv[2]
    problems: list[str] = []
    devices = sorted((source / "eds").glob("*.eds"))
    with tempfile.TemporaryDirectory() as folder:
        counts = [compare_device(path, edsc, Path(folder, f"{path.stem}.dbc"), problems) for path in devices]
        check_mapped_twice(edsc, Path(folder), problems)
    print("\n".join(problems[:40]))
    print(f"{len(devices)} devices, {FRAMES} frames each, {sum(counts)} signals, {len(problems)} problems")
    return 1 if problems or not all(counts) else 0


if __name__ == "__main__":
    sys.exit(main())
