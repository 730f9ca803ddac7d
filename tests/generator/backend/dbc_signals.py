"""The signals that a DBC file of a device has: those of `edsc dump`, computed without code of edsc."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any

Member = dict[str, Any]
EXTENDED, INVALID = 1 << 29, 1 << 31


@dataclass
class Signal:
    entry: str
    name: str
    start: int
    bits: int
    signed: bool
    real: bool = False
    scale: Fraction = Fraction(1)
    offset: Fraction = Fraction(0)
    unit: str = ""
    names: dict[int, str] = field(default_factory=dict)

    def number(self, frame: int) -> int:
        """The raw number of the signal in a frame, of which the first byte is the lowest."""
        bits = frame >> self.start & (1 << self.bits) - 1
        return bits - (1 << self.bits) if self.signed and bits >> self.bits - 1 else bits

    def physical(self, frame: int) -> Fraction:
        return self.number(frame) * self.scale + self.offset


@dataclass
class Message:
    number: int  # as in the file: bit 31 for 29 bits
    length: int
    signals: list[Signal]


def sheet_mapping(names: list[str]) -> str:
    """An EDS whose TPDO 1 maps an UNSIGNED8 for each name, one more than once if it is repeated. The objects begin at 2000h."""
    def section(name: str, **keys: object) -> str:
        return f"[{name}]\n" + "".join(f"{key}={value}\n" for key, value in keys.items())

    def record(index: str, values: list[tuple[str, str]]) -> str:
        text = section(index, ParameterName="PDO parameter", ObjectType="0x9", SubNumber=len(values))
        for sub, (data_type, value) in enumerate(values):
            text += section(f"{index}sub{sub:X}", ParameterName=f"Entry {sub}", ObjectType="0x7", DataType=data_type,
                            AccessType="ro", DefaultValue=value)
        return text

    indices = {name: f"{0x2000 + i:04X}" for i, name in enumerate(dict.fromkeys(names))}
    text = "".join(section(index, ParameterName=name, ObjectType="0x7", DataType="0x5", AccessType="ro", PDOMapping=1)
                   for name, index in indices.items())
    mapped = [("0x7", f"0x{indices[name]}0008") for name in names]
    return (text + record("1800", [("0x5", "2"), ("0x7", "$NODEID+0x180"), ("0x5", "255")])
            + record("1A00", [("0x5", str(len(names))), *mapped]))


def dump_of(edsc: str, path: Path, node_id: int) -> Member:
    output = subprocess.run([edsc, "dump", str(path), "--options", str(path.with_suffix(".options.json")), "--node-id",
                             str(node_id)], check=True, stdout=subprocess.PIPE, text=True, encoding="utf-8").stdout
    return json.loads(output)


def with_meaning(signal: Signal, part: Member) -> Signal:
    quantity = part.get("quantity")
    if quantity:
        signal.scale, signal.offset = Fraction(quantity["scale"]), Fraction(quantity["offset"])
        signal.unit = quantity["unit"]
    signal.names = {one["value"]: one["name"] for one in part.get("values", [])}
    return signal


def bits_name(first: int, last: int) -> str:
    return f"_bit_{first}" if first == last else f"_bits_{first}_to_{last}"


def signals_of(entry: Member, name: str, start: int, bits: int) -> list[Signal]:
    meaning = entry.get("meaning", {})
    label = f"{entry['index']:04X}h:{entry['sub_index']:02X}"
    if not meaning.get("fields"):
        signal = Signal(label, name, start, bits, entry["data_type"].startswith("INTEGER"), entry["data_type"].startswith("REAL"))
        return [with_meaning(signal, meaning)]
    owners: list[Member | None] = [None] * bits
    for one in meaning["fields"]:
        for bit in range(one["first_bit"], one["first_bit"] + one["bits"]):
            owners[bit] = one
    signals, first = [], 0
    while first < bits:
        owner, last = owners[first], first
        while last + 1 < bits and owners[last + 1] is owner:
            last += 1
        if owner is None:
            signals.append(Signal(label, name + bits_name(first, last), start + first, last - first + 1, False))
        elif owner["name"] is not None:
            one = Signal(label, f"{name}_{owner['name']}", start + first, last - first + 1, owner["signed"])
            signals.append(with_meaning(one, owner))
        first = last + 1
    return signals


def messages_of(dump: Member) -> list[Message]:
    """The messages of the enabled PDOs, each CAN-ID once."""
    entries = {(entry["index"], entry["sub_index"]): (item, entry) for item in dump["objects"] for entry in item["entries"]}
    messages: dict[int, Message] = {}
    for pdo in sorted(dump["pdos"], key=lambda one: one["direction"] == "receive"):
        if not pdo.get("valid") or pdo["broken"]:
            continue
        signals = []
        for mapped in pdo["entries"]:
            item, entry = entries.get((mapped["index"], mapped["sub_index"]), (None, None))
            if mapped["dummy"] or item is None or entry is None:
                continue
            # The arrays of the reference devices have elements of one type, which have their number as a name.
            own = {"VAR": "", "ARRAY": f"_{entry['sub_index']}"}.get(item["object_type"], f"_{entry['identifier']}")
            name = item["identifier"] + own
            signals += signals_of(entry, name, mapped["offset"], mapped["bits"])
        cob_id = pdo["cob_id"]
        number = cob_id & 0x1FFFFFFF | INVALID if cob_id & EXTENDED else cob_id & 0x7FF
        messages.setdefault(number, Message(number, (pdo["bits"] + 7) // 8, signals))
    return list(messages.values())
