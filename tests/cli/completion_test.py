#!/usr/bin/env python3
"""Completions and manual page include each command, each option, and each word that an option accepts.

    completion_test.py SOURCE_DIR EDSC [unittest arguments]
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE_DIR, EDSC = (Path(path).resolve() for path in sys.argv[1:3])
KINDS = ("bash", "zsh", "man")
WORDS = ("json", "buses", "nodes", "objects")
ROW = re.compile(r'^    \{"([^"]+)", "([\w-]+)",', re.MULTILINE)
ROWS = ROW.findall((SOURCE_DIR / "cli/commands/commands.hpp").read_text(encoding="utf-8"))
EXIT_CODES = SOURCE_DIR / "cli/shared/exit_code.hpp"
GROUPS = {group: [name for other, name in ROWS if other == group] for group, _ in ROWS}


def run(*arguments: str) -> str:
    return subprocess.run([EDSC, *arguments], capture_output=True, text=True, check=True, timeout=600).stdout


def options_of(text: str) -> set[str]:
    """The options in a help text, `-o,--output TEXT REQUIRED  description`."""
    found = set()
    for line in text.splitlines():
        if match := re.match(r"  (-[\w-]+(?:, -[\w-]+)*)", line):
            found |= set(match[1].split(", "))
    return found


def commands_of(text: str) -> list[str]:
    lists = re.findall(rf"^(?:Commands|{'|'.join(GROUPS)}):\n((?:  .*\n)*)", text, re.MULTILINE)
    return [name for one in lists for name in re.findall(r"^  (\w[\w-]*)", one, re.MULTILINE)]


def arguments_before_commands(text: str) -> list[str]:
    """The positional arguments before the subcommands of a command: `edsc lss BUS COMMAND`."""
    usage = re.search(r"^Usage: .*?\[OPTIONS\](.*) COMMAND$", text, re.MULTILINE)
    return ["socketcan:can0" for _ in usage[1].split()] if usage else []


def all_commands(path: tuple[str, ...] = (), words: tuple[str, ...] = ()) -> dict[tuple[str, ...], str]:
    """The help text of each command, by its path; `words` are the path with arguments."""
    text = run(*words, "--help")
    found = {path: text}
    for command in commands_of(text):
        found |= all_commands((*path, command), (*words, *arguments_before_commands(text), command))
    return found


HELP = all_commands()


class Groups(unittest.TestCase):
    """The help groups the commands by what they work on; so do zsh completion and the manual page."""

    def test_of_the_help(self) -> None:
        headings = re.findall(r"^([A-Z][\w ]*):\n((?:  [a-z].*\n(?:   .*\n)*)+)", HELP[()], re.MULTILINE)
        self.assertEqual({name: re.findall(r"^  ([a-z]+)", rows, re.MULTILINE) for name, rows in headings}, GROUPS)

    def test_of_zsh(self) -> None:
        rows = re.findall(r"commands=\(\n(.*?)\n *\)\n *_describe '([^']*)'", run("completion", "zsh"), re.DOTALL)
        groups = {name: re.findall(r"^ *'(\w+):", text, re.MULTILINE) for text, name in rows if name in GROUPS}
        self.assertEqual(groups, GROUPS)

    def test_of_the_manual_page(self) -> None:
        parts = re.findall(r"^\.SH COMMANDS: (.*)\n((?:(?!\.SH ).*\n)*)", run("completion", "man"), re.MULTILINE)
        found = {title: list(dict.fromkeys(re.findall(r"^\.SS edsc (\w+)", text, re.MULTILINE))) for title, text in parts}
        self.assertEqual(found, {name.upper(): commands for name, commands in GROUPS.items()})


@unittest.skipUnless(shutil.which("bash"), "SKIPPED: bash is not installed")
class Bash(unittest.TestCase):
    def complete(self, *words: str, folder: str = ".", environment: dict[str, str] | None = None) -> set[str]:
        """The completions of bash for these words, the last of which is incomplete."""
        quoted = " ".join("'" + word + "'" for word in words)
        script = f"""{run("completion", "bash")}
compopt() {{ :; }}
COMP_WORDS=(edsc {quoted}); COMP_CWORD={len(words)}; _edsc
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
        result = subprocess.run(["bash", "--norc", "-u"], input=script, capture_output=True, text=True, timeout=600, check=True,
                                cwd=folder, env={**os.environ, "PATH": f"{EDSC.parent}:{os.environ['PATH']}", **(environment or {})})
        self.assertEqual(result.stderr, "")
        return set(result.stdout.split())

    def test_offers_each_command(self) -> None:
        self.assertGreater(len(HELP), 7)
        for path, text in HELP.items():
            if commands_of(text):
                self.assertEqual(self.complete(*path, *arguments_before_commands(text), ""), set(commands_of(text)))
        self.assertIn("decode", self.complete("dec"))

    def test_offers_each_option(self) -> None:
        for path, text in HELP.items():
            with self.subTest(command=path):
                options = options_of(text)
                self.assertIn("--help", options)
                self.assertEqual(self.complete(*path, "-"), options)

    def test_offers_the_words_that_an_option_takes(self) -> None:
        self.assertEqual(self.complete("check", "--format", ""), {"text", "json", "sarif"})
        self.assertEqual(self.complete("check", "--format", "="), {"text", "json", "sarif"})
        self.assertEqual(self.complete("check", "--format", "=", "j"), {"json"})
        self.assertEqual(self.complete("diff", "--format", ""), {"text", "json", "markdown"})
        self.assertEqual(self.complete("generate", "--node-id", ""), set())
        self.assertEqual(self.complete("completion", ""), {*KINDS, *WORDS})

    def test_offers_files(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "drive.eds").touch()
            (Path(folder) / "logs").mkdir()
            self.assertEqual(self.complete("check", "dr", folder=folder), {"drive.eds"})
            self.assertEqual(self.complete("decode", "--node", "5", "=", "dr", folder=folder), {"drive.eds"})
            self.assertEqual(self.complete("generate", "--templates", "", folder=folder), {"logs"})

    def test_offers_buses(self) -> None:
        for command in (("read",), ("scan",), ("network", "scan")):
            with self.subTest(command=command):
                self.assertLessEqual({"socketcand:", "simulated:"}, self.complete(*command, ""))
                self.assertEqual(self.complete(*command, "simu"), {"simulated:"})

    def test_offers_the_nodes_of_the_network_file(self) -> None:
        network = SOURCE_DIR / "examples/networks/eight_devices.json"
        names = set(json.loads(network.read_text(encoding="utf-8"))["nodes"])
        environment = {"EDSC_NETWORK": str(network)}
        for words in (("read", "socketcan:can0", ""), ("conform", "socketcan:can0", ""), ("audit", "--master", "")):
            with self.subTest(words=words):
                self.assertLessEqual(names, self.complete(*words, environment=environment))
                self.assertEqual(self.complete(*words, environment={"EDSC_NETWORK": ""}) & names, set())

    def test_offers_the_objects_of_the_eds(self) -> None:
        words = ("read", "socketcan:can0", "5", "--eds", str(SOURCE_DIR / "eds/rk5c.eds"))
        self.assertEqual(self.complete(*words, "cob_id_s"), {"cob_id_sync"})
        self.assertLessEqual({"device_type", "error_register", "cob_id_sync"}, self.complete(*words, ""))

    def test_offers_rules_and_cases(self) -> None:
        rules = {rule["id"] for rule in json.loads(run("check", "--list-rules", "--format", "json"))["rules"]}
        self.assertGreater(len(rules), 150)
        for option in ("--explain", "--silence"):
            self.assertEqual(self.complete("check", option, ""), rules)
        cases = set(re.findall(r"^  (\d+\.\d+) ", run("conform", "--list"), re.MULTILINE))
        self.assertGreater(len(cases), 150)
        self.assertLessEqual(cases, self.complete("conform", "--only", ""))


class Zsh(unittest.TestCase):
    def test_names_each_option(self) -> None:
        text = run("completion", "zsh")
        self.assertTrue(text.startswith("#compdef edsc\n"))
        for path, help_text in HELP.items():
            name = "_".join(("_edsc", *path))
            function = re.search(rf"^{name}\(\) {{\n(.*?)^}}", text, re.MULTILINE | re.DOTALL)
            self.assertIsNotNone(function, name)
            self.assertEqual(set(re.findall(r"'\*?(-[\w-]+)\[", function[1])), options_of(help_text))
            for command in commands_of(help_text):
                self.assertIn(f"'{command}:", function[1])

    @unittest.skipUnless(shutil.which("zsh"), "SKIPPED: zsh is not installed")
    def test_is_what_zsh_understands(self) -> None:
        """Loads it like compinit, with an _arguments that prints its arguments."""
        script = f"""
_arguments() {{ for spec in "$@"; do print -r -- "$spec"; done; }}
_describe() {{ :; }}
_files() {{ :; }}
_edsc_whole() {{
{run("completion", "zsh")}
}}
_edsc_whole
_edsc_decode
"""
        result = subprocess.run(["zsh", "-f"], input=script, capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual(result.stderr, "")
        self.assertIn("--format[format of the output; json\\: an object on each line; csv\\: a record for each value]:text|json|csv:(text json csv)\n", result.stdout)


class ManPage(unittest.TestCase):
    page = run("completion", "man")

    def test_names_each_command_and_option(self) -> None:
        plain = self.page.replace("\\-", "-")
        for path, help_text in HELP.items():
            if commands_of(help_text):
                continue
            title = " ".join(("edsc", *path))
            section = re.search(rf"^\.SS {title}\n(.*?)(?=^\.S[SH] )", plain, re.MULTILINE | re.DOTALL)
            self.assertIsNotNone(section, title)
            self.assertEqual(set(re.findall(r"\\fB(-[\w-]+)\\fR", section[1])), options_of(help_text), title)
            usage = re.search(r"^Usage: (.*?) \[OPTIONS\]", help_text, re.MULTILINE)[1]
            self.assertIn(f".B {usage}\n", plain)

    def test_has_all_exit_codes(self) -> None:
        page = self.page.split(".SH EXIT STATUS\n")[1].split(".SH")[0]
        codes = re.findall(r"^inline constexpr int exit_\w+ = (\d+);", EXIT_CODES.read_text(encoding="utf-8"), re.MULTILINE)
        self.assertGreater(len(codes), 3)
        self.assertEqual(re.findall(r"^\.B (\d+)$", page, re.MULTILINE), sorted(set(codes), key=int))

    @unittest.skipUnless(shutil.which("groff"), "SKIPPED: groff is not installed")
    def test_is_clean_for_groff(self) -> None:
        result = subprocess.run(["groff", "-man", "-ww", "-Tutf8"], input=self.page, capture_output=True, text=True, timeout=600,
                                check=True)
        self.assertEqual(result.stderr, "")
        self.assertIn("EXIT STATUS", re.sub(".\b", "", result.stdout))

    @unittest.skipUnless(shutil.which("mandoc"), "SKIPPED: mandoc is not installed")
    def test_is_clean_for_mandoc(self) -> None:
        result = subprocess.run(["mandoc", "-Tlint", "-W", "warning"], input=self.page, capture_output=True, text=True, timeout=600,
                                check=False)
        without_date = [line for line in result.stdout.splitlines() if "missing date" not in line]  # the output has no dates
        self.assertEqual(without_date, [])


class Build(unittest.TestCase):
    def test_leaves_the_files_beside_the_program(self) -> None:
        for kind in KINDS:
            self.assertEqual((EDSC.parent / "shell" / f"edsc.{kind}").read_text(), run("completion", kind))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
