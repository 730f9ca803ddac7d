"""Figures of other stacks. Those of peers.json come from a stack that peers.py has rebuilt; the others are quoted: they were measured
once, with the same dictionary, services and compiler.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

REBUILT = Path(__file__).resolve().with_name("peers.json")
BYTES, M4, M0 = "bytes", "M4 -O2", "M0+ -Os"  # kinds of figures
NODE, STACK, MODM = "CANopenNode", "canopen-stack", "modm-canopen, expedited SDO only"
UNNAMED = "another stack"

# By kind and row of the page: stack and value.
QUOTED: dict[str, dict[str, tuple[str, float]]] = {
    BYTES: {
        "flash, static mapping": (NODE, 11808),
        "flash, dynamic mapping": (NODE, 14424),
        "flash, dynamic mapping, block transfer with CRC": (NODE, 16772),
        "RAM, static mapping": (MODM, 1016),
        "RAM, dynamic mapping": (STACK, 3196),
        "dictionary, flash for each entry": (STACK, 13.4),
    },
    M4: {
        "expedited SDO upload, static mapping": (STACK, 321),
        "expedited SDO upload, dynamic mapping": (STACK, 321),
        "expedited SDO download of a new value, static mapping": (STACK, 310),
        "expedited SDO download of a new value, dynamic mapping": (STACK, 310),
        "segmented SDO upload, per byte": (NODE, 36),
        "segmented SDO download, per byte": (NODE, 36),
        "4 RPDOs, SYNC, 4 TPDOs, static mapping": (NODE, 1651),
        "RPDO for the next SYNC": (UNNAMED, 294),
        "`on_time` with nothing due": (UNNAMED, 32),
    },
    M0: {
        "expedited SDO upload, static mapping": (STACK, 400),
        "expedited SDO upload, dynamic mapping": (STACK, 400),
        "expedited SDO download of a new value, static mapping": (STACK, 381),
        "expedited SDO download of a new value, dynamic mapping": (STACK, 381),
        "4 RPDOs, SYNC, 4 TPDOs, static mapping": (NODE, 2297),
        "`on_time` with nothing due": (UNNAMED, 34),
    },
}


@dataclass(frozen=True)
class Other:
    """A figure of another stack."""

    stack: str
    value: float
    is_quoted: bool


def rebuilt() -> dict[str, dict[str, Any]]:
    """Version, commit, date and figures of each rebuilt stack."""
    return json.loads(REBUILT.read_text(encoding="utf-8")) if REBUILT.exists() else {}


def rebuilt_text() -> str:
    """Name, version and date of the rebuilt stacks."""
    return " and ".join(f"{stack} {made['version']} on {made['date']}" for stack, made in rebuilt().items())


def best(kind: str, row: str) -> Other | None:
    """The lowest figure. A rebuilt one replaces the quoted one of the same stack."""
    found = [Other(stack, made["figures"][kind][row], is_quoted=False) for stack, made in rebuilt().items()
             if row in made["figures"].get(kind, {})]
    quoted = QUOTED[kind].get(row)
    if quoted is not None and quoted[0] not in [other.stack for other in found]:
        found.append(Other(*quoted, is_quoted=True))
    return min(found, key=lambda other: other.value, default=None)


def update(stack: str, made: dict[str, Any]) -> None:
    """Replaces what peers.json has of a stack."""
    REBUILT.write_text(json.dumps(rebuilt() | {stack: made}, indent=2) + "\n", encoding="utf-8")
