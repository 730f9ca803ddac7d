"""The behaviours of the slaves, and the expected result of the conformance test for each: one table.

CiA 301 or CiA 305 allows some behaviours; others are properties of the bus or of the computer. They fail no case, and the report
names them. Each fault fails the cases of `failed`, and no other.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .device import Switches

GOOD = Switches()
PYTHON, NODE_JS = "slave.py", "slave.js"


@dataclass(frozen=True)
class Failure:
    """Regular expressions for the expected and the actual result of a failed case."""
    expected: str
    got: str


@dataclass(frozen=True)
class Behaviour:
    """`only`: the cases that run, those that take their time for this behaviour; empty: all."""
    name: str
    what: str
    devices: tuple[Switches, ...] = (GOOD,)
    only: tuple[str, ...] = ()
    level: str = "all"
    program: str = PYTHON
    bridge: bool = False                    # edsc and the slave are on two buses, whose bridge drops remote frames
    timeout_ms: int = 2000                  # of edsc, for SDO; on a busy computer a slave may need more than 500
    failed: dict[str, Failure] = field(default_factory=dict)
    causes: int = 0                         # of the failed cases, as the report counts them
    named: tuple[str, ...] = ()             # regular expressions: each occurs as a reason or warning of a case
    also: tuple[str, ...] = ()              # regular expressions of other reasons that may occur
    ended: str = ""                         # regular expression: why the run ends before the last case; empty: it does not


OPERATIONAL_CASES = ("3.*", "5.*", "6.3", "9.*", "10.*")
REMOTE_FRAME_CASES = ("3.3", "3.9", "3.15", "7.1", "7.2", "7.3", "7.4", "7.5", "7.6", "7.20*")
NOT_RESTORED = {
    "8.8": Failure(r'100Ch:00 after "load" and a reset \(default value\): 0 ', "2000 "),
    "9.1": Failure("100Ch:00 after a reset, as after the first reset: 0 ", "2000 "),
}
NO_LSS = {f"11.{case}": Failure("an answer ", "none") for case in (1, 2, 3, 4, 6, 9, 10, 11, 12, 13, 14, 15)}
SLOW_HEARTBEAT = {"7.102": Failure("20 heartbeats in 2000 ms", r"1\d"), "7.204": Failure("10 heartbeats in 1000 ms", r"\d"),
                  "7.206": Failure("10 heartbeats in 1000 ms", r"\d")}
NO_SUB_INDEX = {"2.5": Failure("read of 1000h:01: an abort with 0609 0011h", "read of 1000h:01: 0602 0000h"),
                "4.5": Failure("each sub-index FFh", "1018h:FF Identity object: refused by the device: 0602 0000h")}
EMCY_REGISTER = {"5.5": Failure("1001h:00, as in the last EMCY: 1 ", "17 "),
                 "5.101": Failure("1001h:00 after a short RPDO, as in the EMCY with code 8210h: 1 ", "17 "),
                 "5.102": Failure("1001h:00 after a lost heartbeat, as in the EMCY with code 8130h: 1 ", "17 ")}
EMCY_INHIBIT = {"5.105": Failure(r"the time between two EMCYs with 1015h = 500 ms: 450\.", r"^[0-9]{1,2}\.")}
READ_ONLY = "1015h:00[^;]*: .*0601 0002h"
EMCY_INHIBIT_READ_ONLY = {"4.10": Failure("accepts the values that it has", READ_ONLY),
                          "4.11": Failure("each writable entry accepts", READ_ONLY),
                          "5.105": Failure("written to 1015h:00", "0601 0002h")}
EARLY_RPDO = {"3.101": Failure("RPDO 1 is not processed in pre-operational", "has the value of the RPDO"),
              "3.103": Failure("RPDO 1 is not processed in Operational if it was received in Pre-operational", "has the value")}
NO_LONGER = r"node 5 no longer responds since case {} \("
TWINS = "two devices have node-ID 5"
LATE_RESPONSE = "does not respond within 500 ms; it responds later: give a longer --timeout"

BEHAVIOURS = (
    # No fault; in parts, because most of the time is waiting.
    Behaviour("good-1", "no fault", only=("1.*", "2.*", "3.*", "4.*", "5.*", "6.*", "8.*")),
    Behaviour("good-7", "no fault", only=("7.*",)),
    Behaviour("good-9", "no fault", only=("9.*", "10.*")),
    Behaviour("good-11", "no fault", only=("11.*",)),
    Behaviour("good-12", "no fault", only=("12.*",), level="hostile"),
    # What CiA 301 and CiA 305 allow, and properties of the bus and of the computer.
    Behaviour("ends-at-reset", "its program ends at a reset", (Switches(ends_at_reset=True),), only=("5.*", "7.*", "8.*"),
              ended=NO_LONGER.format(r"(3\.104|5\.4)")),
    Behaviour("starts-by-itself", "it is Operational after its boot-up message", (Switches(starts_by_itself=True),),
              only=("3.*", "9.*", "10.*"), named=("Operational after its boot-up message",)),
    Behaviour("sends-at-start", "entering Operational is an event of its TPDO", (Switches(sends_at_start=True),),
              only=OPERATIONAL_CASES),
    Behaviour("loses-node-id", "without a node-ID it takes one only after power-on", (Switches(loses_node_id=True),),
              only=("11.*",), ended=NO_LONGER.format(r"11\.9"), named=("no longer responds",)),
    Behaviour("error-set", "1001h is 01h, and it does not stay in Operational", (Switches(error_set=True),),
              only=OPERATIONAL_CASES, named=("not operational after the NMT command; 1001h:00 is 01h",),
              also=("1001h:00 is 01h", "the bus may not carry remote frames", "is not in the state operational",
                    "is not processed in Operational", "sent no EMCY", "sent 0 EMCYs",
                    "do not cause two EMCYs")),
    Behaviour("no-remote-frames", "a bridge drops remote frames", only=REMOTE_FRAME_CASES, bridge=True,
              named=("the bus may not carry remote frames",)),
    Behaviour("late", "it responds after 700 ms", (Switches(answer_delay=0.7),), timeout_ms=500, ended=LATE_RESPONSE),
    Behaviour("slow-store", 'it responds to "save" and "load" after 1.5 s', (Switches(store_delay=1.5),), only=("8.2", "8.4"),
              timeout_ms=1000),
    Behaviour("empty-text", "its only string has no characters", (Switches(empty_text=True),), only=("2.*", "4.*"),
              named=("2001h:00 Text has a value of at most 4 bytes",)),
    Behaviour("no-blocks", "no block transfer", (Switches(no_blocks=True),), only=("2.*",), named=("block transfer",)),
    Behaviour("no-bit-timing", "LSS without services for the bit timing", (Switches(no_bit_timing=True),), only=("11.*",),
              named=("bit rate",)),
    Behaviour("refreshes", "its process values change every 5 ms", (Switches(refreshes=0.005),),
              only=("2.*", "3.*", "4.*", "5.*", "6.*")),
    Behaviour("loaded-host", "each frame is delayed by 0 to 40 ms", (Switches(random_delay=0.04),),
              only=("3.4", "3.5", "6.2", "6.3", "7.102", "7.106", "7.204"), named=("late",)),
    Behaviour("restarts", "its power fails for a moment", (Switches(restarts_after=150),), only=("2.*", "3.*"),
              also=("failed, and the repetition has the verdict",)),
    # What a run cannot decide.
    Behaviour("vanishes", "it vanishes after 150 requests", (Switches(vanishes_after=150),), only=("2.*",),
              ended=NO_LONGER.format(r"2\.\d+")),
    Behaviour("twins", "two devices with one node-ID", (GOOD, Switches(answer_delay=0.003)), ended=TWINS),
    Behaviour("late-twin", "a second device with its node-ID is added", (GOOD, Switches(answer_delay=0.003, joins_at_reset=True)),
              only=("9.*",), ended=TWINS, named=(TWINS,)),
    # Faults.
    Behaviour("keeps-times", "reset communication does not restore 100Ch, 100Dh and 1017h", (Switches(keeps_times=True),),
              only=("8.*", "9.1"), failed=NOT_RESTORED, causes=1),
    Behaviour("no-lss", "no LSS, although the EDS has it", (Switches(no_lss=True),), only=("11.*",), failed=NO_LSS, causes=1),
    Behaviour("rpdo-in-pre-operational", "RPDOs are processed in Pre-operational", (Switches(rpdo_in_pre_operational=True),),
              only=("3.*",), failed=EARLY_RPDO, causes=1),
    Behaviour("slow-heartbeat", "1.5 times the time of 1017h", (Switches(heartbeat_factor=1.5),), only=("7.102", "7.20*"),
              failed=SLOW_HEARTBEAT),
    Behaviour("emcy-register", "the error register of each EMCY is 01h", (Switches(wrong_emcy_register=True),), only=("5.*",),
              failed=EMCY_REGISTER),
    Behaviour("emcy-inhibit", "1015h has no effect", (Switches(no_emcy_inhibit=True),), only=("5.*",), failed=EMCY_INHIBIT),
    Behaviour("emcy-inhibit-read-only", "1015h cannot be written", (Switches(emcy_inhibit_read_only=True),),
              only=("4.10", "4.11", "5.105"), failed=EMCY_INHIBIT_READ_ONLY, causes=1),
    # The same in the slave of slave.js, which has fewer services.
    Behaviour("good", "no fault", program=NODE_JS),
    Behaviour("good-12", "no fault", program=NODE_JS, only=("12.*",), level="hostile"),
    Behaviour("ends-at-reset", "its program ends at a reset", program=NODE_JS, ended=NO_LONGER.format(r"9\.1")),
    Behaviour("starts-by-itself", "it is Operational after its boot-up message", program=NODE_JS, only=("9.*", "10.*"),
              named=("Operational after its boot-up message",)),
    Behaviour("late", "it responds after 700 ms", program=NODE_JS, timeout_ms=500, ended=LATE_RESPONSE),
    Behaviour("empty-text", "its only string has no characters", program=NODE_JS, only=("2.*", "4.*"),
              named=("2001h:00 Longer value has a value of at most 4 bytes",)),
    Behaviour("vanishes", "it vanishes after 40 requests", program=NODE_JS, only=("2.*",), ended=NO_LONGER.format(r"2\.\d+")),
    Behaviour("wrong-code", "the abort code of a missing sub-index is 0602 0000h", program=NODE_JS, only=("2.*", "4.5"),
              failed=NO_SUB_INDEX),
)


def switches_of(name: str) -> tuple[Switches, ...]:
    """Returns those of a behaviour of slave.py; "good" has none."""
    found = [behaviour for behaviour in BEHAVIOURS if behaviour.name == name and behaviour.program == PYTHON]
    return found[0].devices if found else (GOOD,)
