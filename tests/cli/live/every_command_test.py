#!/usr/bin/env python3
"""Each command of edsc with the eight reference devices and the three plants: on their files, and on a bus with all of them.

    every_command_test.py SOURCE_DIR EDSC NODE [unittest arguments]

NODE is the program of one of the devices. The output of the commands is tested elsewhere. This test expects that each command ends
with an exit code that it may have, and that no memory fault is reported: EDSC may be a program with AddressSanitizer, or a
script that runs edsc under valgrind (CONTRIBUTING.md).
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from pathlib import Path

import live
from live import EDSC, FAILED, FINE, SOURCE_DIR, WRONG_USAGE, ReferenceDevices, every_command

MEMORY_FAULT = 99  # as an exit code, which none of the commands has
REPORT = re.compile(r"==\d+==|runtime error:")  # of AddressSanitizer, valgrind; of UBSan
PLANTS = [SOURCE_DIR / f"examples/networks/{plant}.json" for plant in ("eight_devices", "four_modules", "twelve_axes")]
ENVIRONMENT = {**os.environ, "ASAN_OPTIONS": f"exitcode={MEMORY_FAULT}", "UBSAN_OPTIONS": f"exitcode={MEMORY_FAULT}"}


def editor_session(sheet: Path) -> str:
    """The messages of an editor that opens an EDS, asks about each tenth line, and ends."""
    document = {"uri": sheet.as_uri()}
    text = sheet.read_text(encoding="utf-8")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": 100000, "character": 0}}
    messages = [("initialize", {}), ("textDocument/didOpen", {"textDocument": {**document, "version": 1, "text": text}}),
                *((f"textDocument/{name}", {"textDocument": document, "position": {"line": line, "character": 14},
                                            "context": {"includeDeclaration": True}})
                  for line in range(0, text.count("\n"), 10) for name in ("hover", "completion", "definition", "references")),
                *((f"textDocument/{name}", {"textDocument": document, "range": whole, "context": {}})
                  for name in ("codeAction", "inlayHint", "documentSymbol", "foldingRange", "formatting", "codeLens")),
                ("shutdown", {}), ("exit", {})]
    requests = ({"jsonrpc": "2.0", "method": method, "params": params, **({} if method in ("exit", "textDocument/didOpen") else {"id": number})}
                for number, (method, params) in enumerate(messages))
    return "".join(f"Content-Length: {len(one)}\r\n\r\n{one}" for one in map(json.dumps, requests))


class EveryCommand(ReferenceDevices):
    used: set[tuple[str, ...]] = {("bus",)}  # commands that a test has run; setUp() runs `bus`

    @classmethod
    def tearDownClass(cls) -> None:
        """After all tests: no command was forgotten."""
        every = {tuple(name.split()) for name in every_command()}
        assert every == cls.used, f"not the commands of the help: {sorted(every ^ cls.used)}"

    def run_command(self, words: str, *arguments: object, exit_codes: tuple[int, ...] = (FINE,), bus: bool = False,
                    standard_input: str = "") -> None:
        command, *subcommand = words.split()
        self.used.add((command, *subcommand))
        if bus and command in ("lss", "send"):  # edsc send BUS sync, edsc network scan BUS
            line = [EDSC, command, self.network.address, *subcommand]
        else:
            line = [EDSC, command, *subcommand, *([self.network.address] if bus else [])]
        line = [*map(str, line), *map(str, arguments)]
        result = subprocess.run(line, cwd=self.folder, env=ENVIRONMENT, capture_output=True, text=True, errors="replace",
                                timeout=1200, input=standard_input)
        self.assertIn(result.returncode, exit_codes, f"{' '.join(line)}\n{result.stderr}")
        self.assertNotRegex(result.stderr, REPORT, " ".join(line))

    def on_bus(self, words: str, *arguments: object, exit_codes: tuple[int, ...] = (FINE,)) -> None:
        self.run_command(words, *arguments, exit_codes=exit_codes, bus=True)

    def test_1_files_of_devices(self) -> None:
        for kind in ("bash", "zsh", "man"):
            self.run_command("completion", kind)
        self.run_command("help", "check")
        self.run_command("version")
        self.run_command("edit", "missing.eds", "--no-browser", exit_codes=(WRONG_USAGE,))
        for device in self.devices:
            with self.subTest(device):
                sheet = SOURCE_DIR / f"eds/{device}.eds"
                for form in ("text", "json", "sarif"):
                    self.run_command("check", sheet, "--node-id", 5, "--format", form)
                self.run_command("dump", sheet)
                self.run_command("lsp", standard_input=editor_session(sheet))
                self.run_command("dump", sheet, "--cpp", "--node-id", 5)
                self.run_command("generate", sheet, "-o", "out")
                self.run_command("generate", sheet, "-o", "out", "--target", "c")
                self.run_command("generate", sheet, "--node-id", 5, "--dbc", f"{device}.dbc")
                self.run_command("format", sheet)
                self.run_command("format", sheet, "--dcf", "--node-id", 5, "--all", "-o", f"{device}.dcf")
                self.run_command("format", f"{device}.dcf", "--concise", "-o", f"{device}.bin")
                self.run_command("diff", sheet, f"{device}.dcf", "--node-id", 5, exit_codes=(FINE, FAILED))
                self.run_command("diff", sheet, SOURCE_DIR / "eds/rk5c.eds", "--storage", "--format", "markdown",
                                 exit_codes=(FINE, FAILED))
                (self.folder / f"{device}.eds").write_text(sheet.read_text(encoding="utf-8").replace("BaudRate_10=1", "BaudRate_10=0"),
                                                           encoding="utf-8")
                self.run_command("overlay from", sheet, f"{device}.eds", "-o", f"{device}.overlay")
                self.run_command("overlay apply", f"{device}.overlay", "-o", f"applied-{device}.eds")
                self.run_command("overlay rebase", f"{device}.overlay", sheet, "-o", f"rebased-{device}.overlay")
                self.run_command("check", f"{device}.overlay", exit_codes=(FINE, FAILED))
                self.change_objects(f"{device}.eds", sheet)
                self.run_command("document", sheet, "-o", f"{device}.html")
                self.run_command("document", f"{device}.dcf", "--against", sheet, "-o", f"{device}.md")

    def change_objects(self, edited: str, sheet: Path) -> None:
        """Changes a file of the folder with each action of `edsc object`."""
        self.run_command("object add", edited, "5F00h", "Speed", "UNSIGNED16", "rw", "--mappable")
        self.run_command("object add", edited, "5F10h", "Limits", "--record", "Low:INTEGER16:rw=1,High:INTEGER16:rw=2")
        self.run_command("object set", edited, "5F10h:01-02", "HighLimit=500")
        self.run_command("object map", edited, "tpdo", 9, "5F00h", "--cob-id", "0x80000000", exit_codes=(FINE, FAILED))
        self.run_command("object rename", edited, "5F00h", "5F01h")
        self.run_command("object remove", edited, "5F10h", "--dry-run")
        self.run_command("object export", edited, "-o", "objects.csv")
        self.run_command("object import", edited, "objects.csv")
        self.run_command("merge", sheet, edited, sheet)
        self.run_command("new", f"new-{edited}", "--vendor-name", "Acme", "--cia", "402")

    def test_2_plants(self) -> None:
        self.run_command("network members")
        for plant in PLANTS:
            with self.subTest(plant.stem):
                for form in ("text", "json", "sarif"):
                    self.run_command("network check", plant, "--times", "--format", form)
                self.run_command("network generate", plant, "-o", plant.stem)
                self.run_command("document", plant, "--node-pages", "-o", f"{plant.stem}.html")
        self.run_command("network simulate", PLANTS[-1], "--for", "2s")

    def run_as_node(self, node_id: int, sheet: Path) -> None:
        """An EDS as a further node, until it has sent its boot-up message."""
        self.used.add(("node",))
        node = subprocess.Popen([str(EDSC), "node", self.network.address, str(sheet), "--node-id", str(node_id)], env=ENVIRONMENT,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(node.kill)
        self.wait_for(f"{0x700 + node_id:03X} 00")
        node.terminate()
        _, error = node.communicate(timeout=600)
        self.assertNotRegex(error, REPORT)
        self.assertEqual(node.returncode, FINE, error)

    def run_missing_node(self) -> None:
        """A ninth device beside the eight, with the page of the monitor and a log."""
        self.used.add(("network", "run"))
        (self.folder / "ninth.json").write_text(json.dumps({"bit_rate": 125, "nodes": {
            "present": {"node_id": 6, "eds": f"{SOURCE_DIR}/eds/cpd.eds"}, "missing": {"node_id": 21, "eds": f"{SOURCE_DIR}/eds/cpd.eds"}}}))
        run = subprocess.Popen([str(EDSC), "network", "run", self.network.address, "ninth.json", "--log", "run.log", "--web",
                                "127.0.0.1:0"], env=ENVIRONMENT, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.kill)
        self.wait_for("715 00")
        run.terminate()
        _, error = run.communicate(timeout=600)
        self.assertNotRegex(error, REPORT)
        self.assertEqual(run.returncode, FINE, error)

    def test_3_bus(self) -> None:
        """On a bus with all devices; a log of it is the input of the commands for logs."""
        self.start_devices()
        self.run_as_node(20, SOURCE_DIR / "eds/cpd.eds")
        self.run_missing_node()
        with tempfile.TemporaryFile("w+") as log:
            recorder = subprocess.Popen([str(EDSC), "record", self.network.address], stdout=log, stderr=subprocess.PIPE,
                                        text=True, env=ENVIRONMENT)
            self.addCleanup(recorder.communicate)
            self.addCleanup(recorder.kill)
            self.used.add(("record",))
            self.use_devices()
            self.use_lss()
            self.use_plant()
            recorder.terminate()
            self.assertNotRegex(recorder.stderr.read(), REPORT)
            recorder.wait()
            self.assertNotEqual(recorder.returncode, MEMORY_FAULT)
            log.seek(0)
            (self.folder / "bus.log").write_text(log.read())
        self.use_log()

    def use_devices(self) -> None:
        sheets = [f"--eds={SOURCE_DIR}/eds/{device}.eds" for device in self.devices]
        self.on_bus("scan", "--nodes", "1..8", *sheets, "--format", "json")
        for node_id, device in zip(self.node_ids, self.devices):
            with self.subTest(device):
                sheet = SOURCE_DIR / f"eds/{device}.eds"
                self.on_bus("read", node_id, "--all", "--eds", sheet, "--format", "json", exit_codes=(FINE, FAILED))
                self.on_bus("write", node_id, "1017h", "200", "--eds", sheet, "--verify")
                self.on_bus("save", node_id, sheet, "-o", f"saved-{device}.dcf", "--all")
                self.on_bus("configure", node_id, f"saved-{device}.dcf", "--all", exit_codes=(FINE, FAILED))
                self.on_bus("conform", node_id, sheet, "--level", "read", "--html", f"{device}.html", "--junit",
                            f"{device}.xml", exit_codes=(FINE, FAILED))
                self.on_bus("overlay from-bus", node_id, sheet, "-o", f"bus-{device}.overlay", exit_codes=(FINE, FAILED))
                self.on_bus("accept", node_id, sheet, "--html", f"accept-{device}.html", "--json", f"accept-{device}.json", "--junit",
                            f"accept-{device}.xml", "--only", "4.*", exit_codes=(FINE, FAILED))
        self.on_bus("nmt", "start", "all")
        self.on_bus("send sync", "--every", "10ms", "--count", "20")
        self.on_bus("send time")
        self.on_bus("send frame", "123#0102")
        self.on_bus("send pdo", f"6={SOURCE_DIR}/eds/cpd.eds", "1", "controlword=0x06")
        for form in ("text", "json"):
            self.on_bus("monitor", *self.sheets, "--once", "1s", "--bit-rate", "500", "--format", form)

    def use_lss(self) -> None:
        """The numbers are those of the sensor, node 8, which keeps its node-ID. The bus has other LSS slaves, so that commands which
        are not for one of them may fail."""
        numbers = ["--vendor", "93h", "--product", "43354B52h", "--revision", "10001h", "--serial", "1"]
        self.on_bus("nmt", "pre-operational", "all")  # in Operational they do not serve LSS
        self.on_bus("lss fastscan", exit_codes=(FINE, FAILED))
        self.on_bus("lss select", *numbers)
        self.on_bus("lss inquire")
        self.on_bus("lss node-id", 8)
        self.on_bus("lss bit-rate", 250)
        self.on_bus("lss store", exit_codes=(FINE, FAILED))
        self.on_bus("lss activate", "--delay", "10ms")
        self.on_bus("lss state", "waiting")
        self.on_bus("lss assign", *numbers, "--node-id", 8)

    def use_plant(self) -> None:
        self.on_bus("network scan", "--eds", SOURCE_DIR / "eds", "--nodes", "1..8", "-o", "found.json",
                    exit_codes=(FINE, FAILED))
        self.on_bus("network verify", PLANTS[0], "--format", "json", exit_codes=(FINE, FAILED))
        self.on_bus("network apply", PLANTS[0], exit_codes=(FINE, FAILED))

    def use_log(self) -> None:
        for form in ("text", "json", "csv"):
            self.run_command("decode", "bus.log", *self.sheets, "--format", form)
        self.run_command("decode", "bus.log", *self.sheets, "--summary")
        for form in ("text", "json", "html"):
            self.run_command("audit", "bus.log", *self.sheets, "--cycles", "--bit-rate", "500", "--format", form,
                             exit_codes=(FINE, FAILED))
        self.run_command("watch", "bus.log", "--network", PLANTS[0], exit_codes=(FAILED,))
        for form in ("text", "json"):
            self.run_command("replay", "bus.log", *self.sheets, "--all-differences", "--pdos", "--timeout", "100ms", "--format", form,
                             exit_codes=(FINE, FAILED))
            self.run_command("discover", "bus.log", "--eds", SOURCE_DIR / "eds", "-o", f"discovered-{form}.json", "--format", form,
                             exit_codes=(FINE, FAILED))
        self.run_command("plot", "bus.log", "6/1017h", *self.sheets, "-o", "plot.svg")


if __name__ == "__main__":
    live.run()
