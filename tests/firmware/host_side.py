"""The commands of edsc on the serial line of an image: scan, all entries of its EDS, writes, a DCF that remains after a power
loss, NMT states, PDOs, and a node-ID by LSS."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import threading
from pathlib import Path

from data_sheet import DOMAIN, DataSheet, Entry
from machine import Machine
from report import Report

PATIENCE = 20_000  # ms, timeout for an expected answer
LONGEST = 240      # s, for a command
HEARTBEAT, STORE = 0x1017, 0x1010
HEARTBEAT_TIME, EVENT_TIME = 100, 50  # ms, in the DCF
INVALID = 1 << 31  # bit of a COB-ID


def hexadecimal(data: bytes) -> str:
    return data.hex(" ").upper()


class HostSide:
    """Begins with erased flash and ends with the power off."""

    def __init__(self, edsc: Path, machine: Machine, path: Path, sheet: DataSheet, by_lss: bool, report: Report) -> None:
        self.program, self.machine, self.path, self.sheet = edsc, machine, path, sheet
        self.by_lss, self.report = by_lss, report
        self.node = str(sheet.node_id)
        self.stores = sheet.get(STORE, 1) is not None
        self.dcf = machine.folder / "node.dcf"

    def run(self) -> None:
        self.machine.power_off()
        self.machine.erase()
        self.machine.power_on()
        if self.by_lss:
            self.lss()
        self.scan()
        self.read_all()
        self.write()
        self.configure()
        self.monitor()
        self.nmt()
        self.stored()
        self.machine.power_off()

    # ---- commands ----

    def check(self, what: str, got: object, wanted: object) -> None:
        self.report.check("edsc", what, str(got), str(wanted))

    def edsc(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([self.program, command, self.machine.address, *map(str, arguments)], capture_output=True,
                              text=True, timeout=LONGEST)

    def node_command(self, command: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        return self.edsc(command, self.node, *arguments, "--timeout", f"{PATIENCE}ms")

    def done(self, result: subprocess.CompletedProcess[str]) -> bool:
        """Whether a command succeeded; reports its output if not."""
        command = " ".join(map(str, result.args[1:2] + result.args[3:5]))
        self.check(command, f"{result.returncode} {result.stderr}", "0 ")
        return result.returncode == 0

    # ---- expected results ----

    def lss(self) -> None:
        """Configures one device step by step; it boots with its node-ID in the waiting state."""
        for step in (["state", "configuration"], ["node-id", self.node], ["store"]):
            self.done(self.edsc("lss", *step, "--timeout", f"{PATIENCE}ms"))
        inquired = self.edsc("lss", "inquire", "--format", "json", "--timeout", f"{PATIENCE}ms")
        if self.done(inquired):
            address = json.loads(inquired.stdout)["address"]
            for sub, number in ((1, "vendor_id"), (2, "product_code"), (3, "revision_number")):
                self.check(f"lss, {number}", address[number], self.sheet.default(0x1018, sub))
        self.done(self.edsc("lss", "state", "waiting"))

    def scan(self) -> None:
        result = self.edsc("scan", "--nodes", self.node, "--eds", self.path, "--format", "json", "--for", "100ms",
                           "--timeout", f"{PATIENCE}ms")
        if not self.done(result):
            return
        nodes = json.loads(result.stdout)["nodes"]
        self.check("scan", [(node["node_id"], node["device_type"], node["vendor_id"]) for node in nodes],
                   [(self.sheet.node_id, self.sheet.default(0x1000), self.sheet.default(0x1018, 1))])
        fits = [sheet["fit"] for node in nodes for sheet in node["data_sheets"]]
        self.check("scan, EDS", fits, ["same device"])

    def read_all(self) -> None:
        result = self.node_command("read", "--all", "--eds", self.path, "--format", "json")
        found = {(int(row["index"][:4], 16), int(row["index"][6:], 16)): row for row in json.loads(result.stdout)["entries"]}
        no_error = range(1, 255)  # entries of 1003h that have no value, since 1003h:00 is 0
        wanted = {place: entry for place, entry in self.sheet.entries.items() if entry.readable and entry.type != DOMAIN
                  and not (place[0] == 0x1003 and place[1] in no_error)}
        self.check("read --all", sorted(found), sorted(wanted))
        for place in found.keys() & wanted.keys():
            self.entry(wanted[place], found[place])

    def entry(self, entry: Entry, row: dict) -> None:
        """Compares an entry like the python-can walk, with the same exceptions."""
        if row["result"] == "done":
            got = f"reads {row['bytes']}"
        else:
            got = f"abort {row['abort_code']:08X}"
        if entry.default is not None:
            wanted = f"reads {hexadecimal(entry.default)}"
        else:
            long_enough = entry.size is None or len(got) == len("reads") + 3 * entry.size
            wanted = got if row["result"] == "done" and long_enough else f"reads {entry.size} bytes"
        if got == wanted:
            self.report.passed["edsc read"] += 1
        else:
            self.report.check("default", entry.name, got, wanted)

    def write(self) -> None:
        """Writes a value that is read back, and one that the node must refuse."""
        self.done(self.node_command("write", "1017h", 0x1234, "--eds", self.path, "--verify"))
        self.done(self.node_command("write", "1017h", 0, "--eds", self.path, "--verify"))
        refused = self.node_command("write", "1000h", 0, "--eds", self.path, "--force")
        self.check("write --force", (refused.returncode, "0601 0002h" in refused.stderr), (1, True))

    # ---- a DCF ----

    def timed_tpdo(self) -> int | None:
        """The first TPDO that maps objects and has an event timer."""
        for index in range(0x1800, 0x1A00):
            timer = self.sheet.get(index, 5)
            if timer and timer.writable and self.sheet.default(index + 0x200) and self.sheet.default(index, 2) >= 0xFE:
                return index
        return None

    def write_dcf(self) -> None:
        subprocess.run([self.program, "format", self.path, "--dcf", "--all", "--node-id", self.node, "-o", self.dcf],
                       check=True, capture_output=True)
        values = {"1017": HEARTBEAT_TIME}
        if (index := self.timed_tpdo()) is not None:
            values[f"{index:04X}sub1"] = self.sheet.default(index, 1) & ~INVALID
            values[f"{index:04X}sub5"] = EVENT_TIME
        text = self.dcf.read_text(encoding="utf-8")
        for section, value in values.items():
            text, count = re.subn(rf"(\[{section}\][^\[]*?ParameterValue=)[^\n]*", rf"\g<1>{value}", text, flags=re.IGNORECASE)
            self.check("DCF", f"{section}: {count}", f"{section}: 1")
        self.dcf.write_text(text, encoding="utf-8")

    def configure(self) -> None:
        self.write_dcf()
        result = self.node_command("configure", self.dcf, "--all", "--start", *["--store"] * self.stores, "--format", "json")
        told = json.loads(result.stdout or '{"failures": [], "problems": [], "stored": [], "written": 0, "values": 0}')
        self.check("configure", (result.returncode, told["failures"], told["problems"], told["stored"]),
                   (0, [], [], self.stores))
        self.check("configure, values", told["written"], told["values"])

    def monitor(self) -> None:
        """Runs until the heartbeat and the TPDO are printed."""
        words = {"heartbeat": f"HEART     node {self.node} "}
        index = self.timed_tpdo()
        if index is not None:
            words["TPDO"] = f"TPDO {index - 0x17FF} "
        process = subprocess.Popen([self.program, "monitor", self.machine.address, "--node", f"{self.node}={self.path}"],
                                   stdout=subprocess.PIPE, text=True)
        watchdog = threading.Timer(LONGEST, process.kill)
        watchdog.start()
        told: dict[str, str] = {}
        for line in process.stdout:
            if told.keys() == words.keys():
                continue  # one signal: a second one kills edsc while it ends
            told |= {name: line for name, word in words.items() if word in line}
            if told.keys() == words.keys():
                process.send_signal(signal.SIGINT)
        watchdog.cancel()
        self.check("monitor", (process.wait(), sorted(told)), (0, sorted(words)))
        self.check("monitor, state", bool(re.search(r"(?<!pre-)operational", told.get("heartbeat", ""))), True)
        if index is not None:
            self.check("monitor, values", told.get("TPDO", "").count(" = "), self.sheet.default(index + 0x200))

    def nmt(self) -> None:
        for command in ("stop", "pre-operational", "start", "reset-communication", "reset-node"):
            self.done(self.edsc("nmt", command, self.node, "--wait", f"{PATIENCE}ms"))

    def stored(self) -> None:
        self.machine.power_off()
        self.machine.power_on()
        result = self.node_command("read", "1017h", "--eds", self.path, "--format", "json")
        if self.done(result):
            default = self.sheet.default(HEARTBEAT)
            self.check("configure --store", json.loads(result.stdout)["entries"][0]["value"],
                       HEARTBEAT_TIME if self.stores else default)
