#!/usr/bin/env python3
"""Each command of edsc where standard output or standard error is closed or full.

    standard_streams_test.py SOURCE_DIR EDSC LIVE_NODES [unittest arguments]

A command does its work, writes its files, and ends with the exit code of its result, also if nobody can read its messages. It
ends with 2 if output is lost. A signal never ends it.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from dataclasses import dataclass, field

from live import EDSC, FAILED, FINE, SOURCE_DIR, WRONG_USAGE, LiveTest, run, every_command

LOG = "(1.0) vcan0 705#00\n(2.0) vcan0 705#7F\nnot a frame\n"
NUMBERS = ("--vendor", "92h", "--product", "1234h", "--revision", "10002h", "--serial", "100h")


@dataclass(frozen=True)
class Row:
    """A use of a command that ends with this exit code and, if standard error can be written, prints there."""

    words: str
    arguments: tuple[object, ...]
    exit_code: int = FINE
    files: tuple[str, ...] = ()
    bus: bool = False
    warns: bool = field(default=False)
    standard_input: str = ""


def framed(*methods: str) -> str:
    """Messages for `edsc lsp`."""
    texts = [json.dumps({"jsonrpc": "2.0", "method": method, **({} if method == "exit" else {"id": 1})}) for method in methods]
    return "".join(f"Content-Length: {len(text)}\r\n\r\n{text}" for text in texts)


ROWS = (
    Row("completion", ("bash",)),
    Row("help", ("check",)),
    Row("version", ()),
    Row("check", ("warned.eds",)),
    Row("check", ("broken.eds",), FAILED),
    Row("dump", ("warned.eds",), warns=True),
    Row("dump", ("broken.eds",), FAILED, warns=True),
    Row("generate", ("warned.eds", "-o", "out"), files=("out/warned/dictionary.hpp",), warns=True),
    Row("generate", ("broken.eds", "-o", "out"), FAILED, warns=True),
    Row("generate", ("broken.eds", "-o", "out", "--keep-going", "-v"), files=("out/broken/dictionary.hpp",), warns=True),
    Row("format", ("warned.eds", "-o", "new.eds"), files=("new.eds",)),
    Row("format", ("warned.eds", "--dcf", "--node-id", 5, "-o", "new.dcf"), files=("new.dcf",)),
    Row("format", ("warned.eds",)),
    Row("overlay from", ("device.eds", "warned.eds", "-o", "new.overlay"), files=("new.overlay",)),
    Row("overlay apply", ("change.overlay", "-o", "applied.eds"), files=("applied.eds",)),
    Row("overlay rebase", ("change.overlay", "device.eds", "-o", "rebased.overlay"), files=("rebased.overlay",)),
    Row("overlay from-bus", (5, "other.eds", "-o", "bus.overlay"), bus=True),
    Row("new", ("new_device.eds", "--vendor-name", "Acme")),
    Row("object add", ("edited.eds", "5F00h", "Speed", "UNSIGNED16", "rw", "--dry-run")),
    Row("object set", ("edited.eds", "1017h", "ParameterName=Heartbeat")),
    Row("object map", ("edited.eds", "tpdo", 1, "--transmission-type", 1)),
    Row("object rename", ("edited.eds", "1017h", "5F01h", "--dry-run", "--force")),
    Row("object remove", ("edited.eds", "1017h", "--dry-run")),
    Row("object remove", ("edited.eds", "9999h"), FAILED, warns=True),
    Row("object import", ("edited.eds", "objects.csv")),
    Row("object export", ("edited.eds",)),
    Row("merge", ("device.eds", "merged.eds", "device.eds")),
    Row("diff", ("device.eds", "warned.eds")),
    Row("diff", ("device.eds", "broken.eds"), WRONG_USAGE, warns=True),
    Row("document", ("warned.eds", "-o", "page.html"), files=("page.html",)),
    Row("document", ("broken.eds", "-o", "page.html"), FAILED, warns=True),
    Row("edit", ("missing.eds", "--no-browser"), WRONG_USAGE, warns=True),
    Row("lsp", (), standard_input=framed("initialize", "shutdown", "exit")),
    Row("network check", ("plant.json",)),
    Row("network members", ()),
    Row("network generate", ("plant.json", "-o", "plant"), files=("plant/axis.dcf", "plant/plant.dbc"), warns=True),
    Row("network simulate", ("no_rate.json",), FAILED, warns=True),
    Row("network scan", ("--eds", ".", "--nodes", "5..6", "-o", "found.json"), files=("found.json",), bus=True),
    Row("network verify", ("plant.json",), bus=True),
    Row("network apply", ("plant.json",), bus=True),
    Row("scan", ("--nodes", "5..6", "--for", "1ms"), bus=True),
    Row("read", (5, "2FFFh", "--type", "u16"), FAILED, bus=True, warns=True),
    Row("write", (5, "2FFFh", "1", "--type", "u16"), FAILED, bus=True, warns=True),
    Row("configure", (5, "other.dcf"), bus=True),
    Row("save", (5, "device.eds", "-o", "saved.dcf"), files=("saved.dcf",), bus=True),
    Row("save", (5, "device.eds"), bus=True, warns=True),
    Row("monitor", ("--once", "100ms"), bus=True),
    Row("watch", ("--network", "plant.json", "--for", "100ms", "--silence", "node-unknown"), bus=True),
    Row("watch", ("bus.log", "--network", "plant.json"), FAILED, warns=True),
    Row("nmt", ("start", 5), bus=True),
    Row("send sync", (), bus=True),
    Row("send time", (), bus=True),
    Row("send frame", ("123#0102",), bus=True),
    Row("send pdo", (5, "--eds", "device.eds", 1, "nothing=1"), WRONG_USAGE, bus=True, warns=True),
    Row("lss fastscan", (), FAILED, bus=True, warns=True),
    Row("lss select", NUMBERS, FAILED, bus=True, warns=True),
    Row("lss inquire", (), FAILED, bus=True, warns=True),
    Row("lss node-id", (9,), FAILED, bus=True, warns=True),
    Row("lss bit-rate", (250,), FAILED, bus=True, warns=True),
    Row("lss store", (), FAILED, bus=True, warns=True),
    Row("lss activate", ("--delay", "10ms"), bus=True),
    Row("lss state", ("waiting",), bus=True),
    Row("lss assign", (*NUMBERS, "--node-id", 9), FAILED, bus=True, warns=True),
    Row("conform", (5, "device.eds", "--only", "1.0", "--html", "conform.html", "--json", "conform.json"),
        files=("conform.html", "conform.json"), bus=True),
    Row("accept", (5, "device.eds", "--only", "1.0", "--html", "accept.html", "--json", "accept.json"),
        files=("accept.html", "accept.json"), bus=True),
    Row("record", ("--for", "100ms", "-o", "recorded.log"), bus=True),
    Row("decode", ("bus.log", "--node", "5=device.eds"), FAILED, warns=True),
    Row("decode", ("bus.log", "--node", "5=device.eds", "--format", "csv"), FAILED, warns=True),
    Row("audit", ("bus.log", "--node", "5=device.eds"), FAILED, warns=True),
    Row("replay", ("bus.log", "--node", "5=device.eds"), FAILED, warns=True),
    Row("discover", ("bus.log", "-o", "found.json"), FAILED, files=("found.json",), warns=True),
    Row("plot", ("bus.log", "1017h", "--node", "5=device.eds"), FAILED, warns=True),
)
ENDLESS = {"bus", "node", "network run"}  # until SIGINT


class PreparedFiles(LiveTest):
    """The files of the rows."""

    def setUp(self) -> None:
        super().setUp()
        text = (self.folder / "device.eds").read_text()
        self.write("warned.eds", text.replace("EDSVersion=4.0", "EDSVersion=4.0\nNoSuchKey=1"))
        self.write("broken.eds", text.replace("DataType=0x0007", "DataType=0x7777", 1))
        self.write("other.eds", text.replace("=0x00001001", "=0x00001002"))
        for name in ("edited.eds", "merged.eds"):
            self.write(name, (self.folder / "device.eds").read_text(encoding="utf-8"))
        self.write("objects.csv", "index,sub,name,type,access,default,low,high,unit\n1017h,,Heartbeat,,,,,,\n")
        self.write("change.overlay", "[Overlay]\nVersion=1\nBase=device.eds\n\n[1017]\nDefaultValue=0 => 100\n")
        subprocess.run([EDSC, "format", "device.eds", "--dcf", "--node-id", "5", "-o", "other.dcf"], cwd=self.folder, check=True,
                       capture_output=True)
        self.write("plant.json", json.dumps({"bit_rate": 500, "nodes": {"axis": {"node_id": 5, "eds": "warned.eds"}}}))
        self.write("no_rate.json", json.dumps({"nodes": {"axis": {"node_id": 7, "eds": "device.eds"}}}))
        self.write("bus.log", LOG)
        self.before = set(self.folder.rglob("*"))

    def write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text)


class StandardStreams(PreparedFiles):
    def line(self, row: Row) -> list[str]:
        command, *subcommand = row.words.split()
        if row.bus and command in ("lss", "send"):
            words = [command, self.network.address, *subcommand]
        else:
            words = [command, *subcommand, *([self.network.address] if row.bus else [])]
        return [str(EDSC), *map(str, (*words, *row.arguments))]

    def run_with(self, line: list[str], redirection: str, standard_input: str = "") -> subprocess.CompletedProcess[str]:
        """Runs a command with a redirection of the shell, such as `2>&-`."""
        return subprocess.run(["sh", "-c", f'"$@" {redirection}', "sh", *line], cwd=self.folder, capture_output=True, text=True,
                              errors="replace", timeout=600, input=standard_input)

    def remove_output(self) -> None:
        for path in sorted(set(self.folder.rglob("*")) - self.before, reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()

    def expect_files(self, row: Row) -> None:
        for name in row.files:
            self.assertGreater((self.folder / name).stat().st_size, 0, name)

    def test_a_row_for_each_command(self) -> None:
        self.assertEqual({row.words for row in ROWS} | ENDLESS, every_command())

    def test_each_command(self) -> None:
        for row in ROWS:
            line = self.line(row)
            with self.subTest(command=" ".join(line[1:])):
                normal = self.run_with(line, "", row.standard_input)
                self.assertEqual(normal.returncode, row.exit_code, normal.stdout + normal.stderr)
                self.assertTrue(normal.stderr or not row.warns, "prints nothing to standard error")
                self.expect_files(row)
                self.remove_output()
                for redirection in ("2>&-", "2>/dev/full"):
                    result = self.run_with(line, redirection, row.standard_input)
                    self.assertEqual((redirection, result.returncode, bool(result.stdout)),
                                     (redirection, row.exit_code, bool(normal.stdout)))
                    self.expect_files(row)
                    self.remove_output()
                for redirection in (">&-", ">/dev/full", ">&- 2>&-", ">/dev/full 2>/dev/full"):
                    result = self.run_with(line, redirection, row.standard_input)
                    self.assertEqual((redirection, result.returncode),
                                     (redirection, WRONG_USAGE if normal.stdout else row.exit_code))
                    self.remove_output()

    def test_wrong_usage_and_help(self) -> None:
        for words in ("", *sorted(every_command())):
            with self.subTest(command=words):
                wrong = [str(EDSC), *words.split(), "--no-such-option"]
                for redirection in ("", "2>&-", "2>/dev/full", ">&- 2>&-", ">/dev/full 2>/dev/full"):
                    self.assertEqual(self.run_with(wrong, redirection).returncode, WRONG_USAGE, redirection)
                help_line = [str(EDSC), *words.split(), "--help"]
                for redirection, exit_code in (("2>&-", FINE), ("2>/dev/full", FINE), (">&-", WRONG_USAGE),
                                               (">/dev/full 2>/dev/full", WRONG_USAGE)):
                    self.assertEqual(self.run_with(help_line, redirection).returncode, exit_code, redirection)

    def test_a_reader_that_has_gone_does_not_end_the_work(self) -> None:
        """A pipe for standard error whose other end is closed."""
        for row in ROWS:
            if not (row.warns and row.files):
                continue
            with self.subTest(command=row.words):
                reading, writing = os.pipe()
                os.close(reading)
                with os.fdopen(writing) as closed_pipe:
                    result = subprocess.run(self.line(row), cwd=self.folder, stdout=subprocess.DEVNULL, stderr=closed_pipe,
                                            timeout=600, check=False)
                self.assertEqual(result.returncode, row.exit_code)
                self.expect_files(row)
                self.remove_output()

    def test_a_bus(self) -> None:
        """It ends at SIGINT only, and at once if it cannot print its address."""
        line = [str(EDSC), "bus", "--listen", "127.0.0.1:0"]
        for redirection in (">&-", ">/dev/full"):
            self.assertEqual(self.run_with(line, redirection).returncode, WRONG_USAGE, redirection)
        for redirection in ("2>&-", "2>/dev/full"):
            with subprocess.Popen(["sh", "-c", f'exec "$@" {redirection}', "sh", *line], stdout=subprocess.PIPE, text=True) as bus:
                self.assertIn("socketcand:", bus.stdout.readline())
                time.sleep(0.1)
                bus.send_signal(signal.SIGINT)
                self.assertEqual(bus.wait(timeout=600), FINE)


if __name__ == "__main__":
    run()
