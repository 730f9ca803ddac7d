#!/usr/bin/env python3
"""One command-line language: an option has one meaning in all commands, a meaning one option, durations one notation.

    vocabulary_test.py SOURCE_DIR EDSC [--write] [unittest arguments]

--write writes the table of the options in docs/command-line.md.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from collections import defaultdict
from pathlib import Path

SOURCE_DIR = Path(sys.argv[1]).resolve()
EDSC = Path(sys.argv[2]).resolve()
PAGE = SOURCE_DIR / "docs/command-line.md"
SHEET = SOURCE_DIR / "eds/rk5c.eds"
TABLE = re.compile(r"(?<=<!-- options -->\n)(.*?)(?=<!-- end of options -->)", re.DOTALL)
NOWHERE = "socketcand:127.0.0.1:1/vcan0"  # no server listens there
WRONG_USAGE = 2
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith("EDSC_")}
# Not one of them is a number or a duration.
WRONG_NUMBERS = ("nan", "NaN", "inf", "-inf", "infinity", "-1", "1e3", "1e400", "0x", "1.5", "99999999999999999999", "", " 5", "5 ",
                 "١")
WRONG_DURATIONS = ("nan", "inf", "-1s", "1e3s", "nans", "infms", "5 s", "1.5.2s", ".5s", "5.s", "s", "1d", "1 h",
                   "99999999999999999999h", "0.1us", "")


def edsc(*arguments: object, environment: dict[str, str] | None = None, **more: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([EDSC, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
                          env={**ENVIRONMENT, **(environment or {})}, check=False, **more)


LANGUAGE = json.loads(edsc("completion", "json").stdout)
COMMANDS = LANGUAGE["commands"]
VOCABULARY = {row["name"]: row for row in LANGUAGE["vocabulary"]}
OLD = LANGUAGE["old_options"]


def long_name(option: dict) -> str:
    return next(name for name in option["names"] if name.startswith("--"))


def all_options() -> list[tuple[dict, dict]]:
    return [(command, option) for command in COMMANDS for option in command["options"]]


def command_line(command: dict, with_subcommand: bool = False) -> list[str]:
    """The words of a command; `edsc lss BUS assign` has BUS between them."""
    words = [NOWHERE if word == "BUS" else word for word in command["usage"].split(" [OPTIONS]")[0].split()[1:]]
    return words + {"lss": [NOWHERE, "inquire"], "send": [NOWHERE, "sync"]}.get(command["command"], []) * with_subcommand


def table_of_options() -> str:
    users = defaultdict(list)
    for command, option in all_options():
        users[long_name(option)].append(command["command"] or "edsc")
    every = len(COMMANDS)
    rows = ["| option | meaning | commands |", "|---|---|---|"]
    for name, row in VOCABULARY.items():
        names = ", ".join(filter(None, (row["short"], name)))
        used = "all" if len(users[name]) == every else ", ".join(f"`{command}`" for command in users[name])
        rows.append("| `{}` | {} | {} |".format(f"{names} {row['value']}".strip(), row["meaning"], used))
    return "\n".join(rows) + "\n"


class OneMeaning(unittest.TestCase):
    def test_of_each_option(self) -> None:
        """Each command states the meaning of the vocabulary first."""
        self.assertGreater(len(all_options()), 250)
        for command, option in all_options():
            with self.subTest(command=command["command"], option=option["names"]):
                row = VOCABULARY[long_name(option)]
                self.assertEqual(set(option["names"]), set(filter(None, (row["name"], row["short"]))))
                meaning, detail = row["meaning"], option["description"]
                self.assertTrue(detail == meaning or detail.startswith(meaning + "; "), detail)
                if row["kind"] == "flag":
                    self.assertEqual((option["value"], option["kind"]), ("", "flag"))
                elif not option.get("words"):
                    self.assertEqual((option["value"], option["kind"]), (row["value"], row["kind"]))

    def test_has_one_name(self) -> None:
        for key in ("name", "meaning"):
            values = [row[key].lower() for row in LANGUAGE["vocabulary"]]
            self.assertEqual(len(values), len(set(values)), key)
        used = {long_name(option) for _, option in all_options()}
        self.assertEqual(set(VOCABULARY), used)

    def test_of_the_short_names(self) -> None:
        short = [row["short"] for row in LANGUAGE["vocabulary"] if row["short"]]
        self.assertEqual(sorted(short), sorted({"-h", "-V", "-o", "-i", "-v"}))

    def test_of_the_order_of_arguments(self) -> None:
        """BUS, then NODE or an action, then FILE."""
        for command in COMMANDS:
            names = [argument["names"][0] for argument in command["arguments"]]
            if "BUS" in names:
                self.assertEqual(names[0], "BUS", command["command"])
            if "NODE" in names and "FILE" in names:
                self.assertLess(names.index("NODE"), names.index("FILE"), command["command"])

    def test_is_in_the_documents(self) -> None:
        self.assertEqual(TABLE.search(PAGE.read_text(encoding="utf-8"))[1], table_of_options(),
                         "run vocabulary_test.py SOURCE_DIR EDSC --write")


class Values(unittest.TestCase):
    def refused(self, command: dict, option: dict, value: str) -> None:
        name = long_name(option)
        result = edsc(*command_line(command, True), f"{name}={value}" if value else name, *([] if value else [""]))
        self.assertEqual(result.returncode, WRONG_USAGE, f"{command['command']} {name} {value!r}: {result.stderr}")
        self.assertIn(name, result.stderr, value)
        self.assertIn(f'"{value}"', result.stderr, name)
        self.assertTrue(result.stderr.startswith("edsc: "), result.stderr)

    def options_of_kind(self, kind: str) -> list[tuple[dict, dict]]:
        found = [(command, option) for command, option in all_options() if option["kind"] == kind]
        self.assertGreater(len(found), 7)
        return found

    def test_a_number_is_a_number(self) -> None:
        for command, option in self.options_of_kind("number"):
            for value in WRONG_NUMBERS:
                with self.subTest(command=command["command"], option=option["names"], value=value):
                    self.refused(command, option, value)

    def test_a_duration_has_a_unit(self) -> None:
        for command, option in self.options_of_kind("duration"):
            self.assertEqual(option["value"], "DURATION")
            for value in WRONG_DURATIONS:
                with self.subTest(command=command["command"], option=option["names"], value=value):
                    self.refused(command, option, value)

    def test_all_durations_have_one_notation(self) -> None:
        for command, option in self.options_of_kind("duration"):
            for value in ("20ms", "1s", "0.5s", "1m"):
                with self.subTest(command=command["command"], option=option["names"], value=value):
                    result = edsc(*command_line(command, True), long_name(option), value)
                    self.assertNotIn("is not a duration", result.stderr)
            result = edsc(*command_line(command, True), long_name(option), "999999h")
            self.assertRegex(result.stderr, r'^edsc: (--[a-z-]+: "999999h" is not from \S+ to \S+|[A-Z]+ is required.*)\n')

    def test_default_values_are_durations(self) -> None:
        for _, option in self.options_of_kind("duration"):
            if "default" in option:
                self.assertRegex(option["default"], r"^\d+(us|ms|s|m|h)$")


class OldSpellings(unittest.TestCase):
    """They work for one version, with a note."""

    def commands_with(self, row: dict) -> list[dict]:
        return [command for command in COMMANDS if not row["command"] or command["command"] == row["command"]
                or command["command"].startswith(row["command"] + " ")]

    def test_have_a_note(self) -> None:
        for row in OLD:
            commands = [command for command in self.commands_with(row) if any(
                row["now"] in (option["names"]) for option in command["options"])] or self.commands_with(row)
            for command in commands:
                with self.subTest(command=command["command"], old=row["name"]):
                    value = "7" if row["unit"] else "x"
                    result = edsc(*command_line(command), row["name"], *([] if row["value"] or self.is_flag(command, row) else [value]), "--help")
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertTrue(result.stderr.startswith("edsc: note: "), result.stderr)
                    self.assertIn(row["now"], result.stderr)
                    if row["unit"]:
                        self.assertIn(f'{row["now"]} 7{row["unit"]}"', result.stderr)

    def is_flag(self, command: dict, row: dict) -> bool:
        return any(row["now"] in option["names"] and option["kind"] == "flag" for option in command["options"])

    def test_do_not_have_a_present_meaning(self) -> None:
        for row in OLD:
            for command in self.commands_with(row):
                names = {name for option in command["options"] for name in option["names"]}
                if row["name"] != row["now"]:
                    self.assertNotIn(row["name"], names)

    def test_mean_the_same(self) -> None:
        old = edsc("check", "--all", SHEET)
        self.assertEqual(old.stderr, "edsc: note: --all is called --all-findings now\n")
        self.assertEqual(old.stdout, edsc("check", "--all-findings", SHEET).stdout)
        old = edsc("record", NOWHERE, "--seconds", "0.5")
        self.assertTrue(old.stderr.startswith('edsc: note: "--seconds 0.5" is written "--for 0.5s" now\n'), old.stderr)
        old = edsc("record", NOWHERE, "--for", "5min")
        self.assertTrue(old.stderr.startswith('edsc: note: "--for 5min" is written "--for 5m" now\n'), old.stderr)


class Usage(unittest.TestCase):
    def wrong(self, *arguments: object, message: str, **more: object) -> None:
        result = edsc(*arguments, **more)
        self.assertEqual((result.returncode, result.stdout), (WRONG_USAGE, ""), result.stderr)
        self.assertIn(message, result.stderr)
        self.assertTrue(result.stderr.startswith("edsc: "), result.stderr)

    def test_a_missing_command(self) -> None:
        self.wrong(message="Usage: edsc COMMAND")
        self.assertLess(len(edsc().stderr.splitlines()), 15)
        self.wrong("network", message="edsc: edsc network needs a command: check, generate,")

    def test_suggestions(self) -> None:
        self.wrong("--verson", message='edsc: unknown option "--verson"; did you mean "--version"?\n')
        self.wrong("check", "--formt", "json", message='edsc: unknown option "--formt" of edsc check; did you mean "--format"?\n')
        self.wrong("network", "chek", message='edsc: unknown command "chek" of edsc network; did you mean "check"?\n')
        self.wrong("help", "network", "chek", message='edsc: unknown command "chek" of edsc network; did you mean "check"?\n')
        self.wrong("lss", NOWHERE, "assign", "--vendr", message='did you mean "--vendor"?')
        self.wrong("lss", NOWHERE, "assign", "--timeot", message='did you mean "--timeout"?')  # of edsc lss

    def test_help_and_version(self) -> None:
        for command in COMMANDS:
            words = command["command"].split()
            help_text = edsc("help", *words)
            self.assertEqual((help_text.returncode, help_text.stderr), (0, ""))
            self.assertEqual(help_text.stdout, edsc(*command_line(command), "--help").stdout)
            self.assertEqual(help_text.stdout, edsc(*command_line(command), "-h").stdout)
        self.assertEqual({edsc(word).stdout for word in ("version", "--version", "-V")}, {edsc("version").stdout})

    def test_help_is_at_most_80_columns_wide(self) -> None:
        for command in COMMANDS:
            text = edsc("help", *command["command"].split()).stdout
            without_examples = text.split("\nExamples:")[0]
            too_wide = [line for line in without_examples.splitlines() if len(line) > 80]
            self.assertEqual(too_wide, [], command["command"])

    def test_a_file_named_like_an_option(self) -> None:
        """It is not an option, and does not end the check of the other files."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "-h.eds").write_text("not an EDS")
            self.wrong("check", SHEET, "-h.eds", cwd=folder,
                       message='edsc: unknown option "-h.eds" of edsc check; write "-- -h.eds" for a file of this name\n')
            for word in ("-help", "-hv", "-Vx", "--help.eds", "-x.eds"):
                self.wrong("check", SHEET, word, message=f'unknown option "{word}"')
            found = edsc("check", SHEET, "--", "-h.eds", cwd=folder)
            self.assertEqual(found.returncode, 1)
            self.assertIn("-h.eds:1:1: error:", found.stdout)

    def test_two_dashes_in_each_command(self) -> None:
        """What follows them is an argument, or one too many."""
        for command in COMMANDS:
            if "COMMAND" in command["usage"].split() or command["command"] in ("", "bus"):  # -x.eds is a name of a bus
                continue
            with self.subTest(command=command["command"]):
                words = command_line(command)
                result = edsc(*words, "--", *([NOWHERE] if "BUS" in command["usage"].split()[-len(command["arguments"]):] else []), "-x.eds")
                self.assertNotIn("unknown option", result.stderr)

    def test_colours(self) -> None:
        import pty
        for terminal, coloured in (("dumb", False), ("xterm", True)):
            ours, theirs = pty.openpty()
            with tempfile.NamedTemporaryFile(suffix=".eds") as empty:
                environment = {name: value for name, value in ENVIRONMENT.items() if name != "NO_COLOR"}
                subprocess.run([EDSC, "check", empty.name], stdout=theirs, stderr=theirs, check=False, timeout=600,
                               env={**environment, "TERM": terminal})
            os.close(theirs)
            self.assertEqual(b"\x1b[" in os.read(ours, 10000), coloured, terminal)
            os.close(ours)


class DefaultBus(unittest.TestCase):
    """EDSC_BUS is BUS, unless the first argument is an address."""

    def opened(self, *arguments: object, bus: str = NOWHERE) -> str:
        result = edsc(*arguments, environment={"EDSC_BUS": bus})
        self.assertEqual(result.returncode, WRONG_USAGE, result.stderr)
        return result.stderr

    def test_is_used_by_each_command_for_a_bus(self) -> None:
        for arguments in (("scan",), ("read", 5, "1018h"), ("write", 5, "1017h", 1, "--type", "u16"), ("monitor",), ("monitor", "--web"),
                          ("record",), ("nmt", "start", "all"), ("send", "sync"), ("send", "--every", "10ms", "sync"),
                          ("lss", "fastscan"), ("lss", "--step", "10ms", "inquire"), ("conform", 5, SHEET), ("accept", 5, SHEET),
                          ("save", 5, SHEET), ("scan", "--nodes", "1..3"), ("read", "--", 5, "1018h"),
                          ("network", "scan", "--eds", SOURCE_DIR / "eds")):
            with self.subTest(arguments=arguments):
                self.assertIn("127.0.0.1:1", self.opened(*arguments))

    def test_an_address_on_the_command_line_wins(self) -> None:
        other = "socketcand:127.0.0.1:2/other"
        for arguments in (("scan", other), ("read", other, 5, "1018h"), ("lss", other, "inquire"), ("record", "--count", 1, other)):
            self.assertIn("127.0.0.1:2", self.opened(*arguments))

    def test_is_not_guessed(self) -> None:
        self.assertIn('edsc: unexpected argument "can0"\n', self.opened("scan", "can0"))
        self.assertIn('"can0" is not a bus address', self.opened("scan", "can0", bus=""))
        self.assertIn("BUS is required", self.opened("scan", bus=""))
        self.assertIn("EDSC_BUS", self.opened("read", 5, "1018h", bus=""))


class Folders(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in ("a.eds", "deep/er/b.EDS", "deep/c.dcf", ".git/d.eds", "deep/notes.txt"):
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("not an EDS")

    def found(self, *arguments: object) -> list[str]:
        result = edsc(*arguments, cwd=self.folder)
        return re.findall(r"^(\S+?):1:1: error", result.stdout + result.stderr, re.MULTILINE)

    def test_are_searched_with_their_subfolders(self) -> None:
        self.assertEqual(self.found("check", "."), ["a.eds", "deep/c.dcf", "deep/er/b.EDS"])
        self.assertEqual(self.found("check", "deep"), ["deep/c.dcf", "deep/er/b.EDS"])
        self.assertEqual(self.found("format", "--check", "."), ["a.eds", "deep/c.dcf", "deep/er/b.EDS"])

    def test_without_a_file_are_an_error(self) -> None:
        (self.folder / "empty").mkdir()
        result = edsc("check", "empty", cwd=self.folder)
        self.assertEqual((result.returncode, result.stderr),
                         (WRONG_USAGE, "edsc: empty: the folder and its subfolders have no EDS, DCF or XDD file\n"))


if __name__ == "__main__":
    if sys.argv[3:4] == ["--write"]:
        text = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(TABLE.sub(lambda _: table_of_options(), text), encoding="utf-8")
    else:
        unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
