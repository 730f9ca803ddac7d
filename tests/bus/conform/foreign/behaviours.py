"""The behaviours of the slaves, and the expected result of the conformance test for each: one table.

A behaviour that CiA 301 or CiA 305 allows, or that is a property of the bus or of the computer, fails no case; the report names
it. A behaviour that is a fault fails the cases of `failed`, and no other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .device import Switches

GOOD = Switches()
SLOW_CASES = ("7.*", "11.*")  # more than half of the time


@dataclass(frozen=True)
class Failure:
    """Regular expressions for the expected and the actual result of a failed case."""
    expected: str
    got: str


@dataclass(frozen=True)
class Behaviour:
    name: str
    what: str
    devices: tuple[Switches, ...] = (GOOD,)
    only: tuple[str, ...] = ()              # cases; empty: all
    bridge: bool = False                    # edsc and the slave are on two buses, whose bridge drops remote frames
    timeout_ms: int = 2000                  # of edsc, for SDO; on a busy computer a slave may need more than 500
    failed: dict[str, Failure] = field(default_factory=dict)
    named: tuple[str, ...] = ()             # regular expressions: each occurs in a reason, a warning or a finding of the run
    ended: str = ""                         # regular expression: why the run ends before the last case; empty: it does not


BEHAVIOURS = (
    Behaviour("good-1", "no fault", only=("1.*", "2.*", "3.*", "4.*", "5.*", "6.*", "8.*")),
    Behaviour("good-7", "no fault", only=("7.*", "9.*")),
    Behaviour("good-10", "no fault", only=("10.*", "11.*")),
    Behaviour("ends-at-reset", "its program ends at a reset", (Switches(ends_at_reset=True),)),
    Behaviour("starts-by-itself", "it is Operational after its boot-up message", (Switches(starts_by_itself=True),)),
    Behaviour("loses-node-id", "without a node-ID it takes one only after power-on", (Switches(loses_node_id=True),), only=("11.*",)),
    Behaviour("error-set", "1001h is 01h, and it does not stay in Operational", (Switches(error_set=True),)),
    Behaviour("no-remote-frames", "a bridge drops remote frames", bridge=True),
    Behaviour("late", "it responds after 700 ms", (Switches(answer_delay=0.7),), timeout_ms=500),
    Behaviour("empty-text", "its only string has no characters", (Switches(empty_text=True),), only=("2.*", "4.*")),
    Behaviour("no-bit-timing", "no services for the bit timing", (Switches(no_bit_timing=True),), only=("11.*",)),
    Behaviour("twins", "two devices with one node-ID", (GOOD, Switches(answer_delay=0.003))),
    Behaviour("refreshes", "its process value changes every 5 ms", (Switches(refreshes=0.005),)),
    Behaviour("vanishes", "it vanishes after 150 requests", (Switches(vanishes_after=150),)),
    Behaviour("loaded-host", "each frame is delayed by 0 to 40 ms", (Switches(random_delay=0.04),)),
    Behaviour("keeps-times", "reset communication does not restore 100Ch, 100Dh and 1017h", (Switches(keeps_times=True),)),
    Behaviour("no-lss", "no LSS, although the EDS has it", (Switches(no_lss=True),), only=("11.*",)),
    Behaviour("rpdo-in-pre-operational", "RPDOs are processed in Pre-operational", (Switches(rpdo_in_pre_operational=True),)),
    Behaviour("slow-heartbeat", "1.5 times the time of 1017h", (Switches(heartbeat_factor=1.5),)),
    Behaviour("emcy-register", "the error register of each EMCY is 01h", (Switches(wrong_emcy_register=True),)),
    Behaviour("emcy-inhibit", "1015h has no effect", (Switches(no_emcy_inhibit=True),)),
)


def find_behaviour(name: str) -> Behaviour:
    return next(behaviour for behaviour in BEHAVIOURS if behaviour.name == name)
