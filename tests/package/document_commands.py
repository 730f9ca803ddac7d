"""Runs the commands of a document in their order, with the programs that it starts in the background.

The arguments of the scripts that use it are SOURCE_DIR and BUILD_DIR. BUILD_DIR takes the place of build/demo. The bus of the
document has a free port.
"""

from __future__ import annotations

import os
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

SOURCE_DIR, BUILD_DIR = (Path(argument).resolve() for argument in sys.argv[1:3])
PATIENCE = 600.0  # maximum seconds until a line, on a busy machine
READY = {  # what a program of a document prints first
    "edsc": "socketcand:.*",
    "qemu-system-arm": "char device redirected to .*",
    "pump_node": "node 5 is on the bus",
}


def free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class Program:
    """A program that the document starts with `&`, and what it prints."""

    def __init__(self, command: str, folder: Path, variables: dict[str, str]) -> None:
        self.process = subprocess.Popen(["bash", "-c", f"exec {command}"], cwd=folder, env=variables, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.lines: list[str] = []
        self.thread = threading.Thread(target=self.read, daemon=True)
        self.thread.start()

    def read(self) -> None:
        for line in self.process.stdout:
            self.lines.append(line.rstrip("\n"))

    def wait_for(self, line: str, count: int = 1) -> None:
        end = time.monotonic() + PATIENCE
        while sum(re.fullmatch(line, one) is not None for one in self.lines) < count:
            if time.monotonic() > end or self.process.poll() is not None:
                raise AssertionError(f"{line} not printed {count} times:\n" + "\n".join(self.lines))
            time.sleep(0.02)

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        self.thread.join()
        self.process.stdin.close()
        self.process.stdout.close()


class DocumentTest(unittest.TestCase):
    maxDiff = None

    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-document-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("eds", "examples"):
            shutil.copytree(SOURCE_DIR / name, self.folder / name)
        (self.folder / "build").mkdir()
        (self.folder / "build/demo").symlink_to(BUILD_DIR)
        self.variables = {**os.environ, "PATH": f"{BUILD_DIR / 'generator'}{os.pathsep}{os.environ['PATH']}"}
        if shutil.which("ccache"):
            self.variables |= {"CMAKE_CXX_COMPILER_LAUNCHER": "ccache", "CCACHE_BASEDIR": str(self.folder)}
        self.port = str(free_port())
        self.programs: dict[str, Program] = {}
        self.addCleanup(self.end_programs)

    def end_programs(self) -> None:
        for program in reversed(self.programs.values()):
            program.end()

    def run_document(self, document: str) -> dict[str, str]:
        """Returns what each command has printed, the last time if it occurs twice."""
        return dict(self.run_commands(document))

    def run_commands(self, document: str) -> list[tuple[str, str]]:
        """Returns each command and what it has printed."""
        mark = Path(sys.argv[0]).name
        pattern = re.compile(rf"<!-- run by: tests/package/{re.escape(mark)} -->\n```sh\n(.*?)```", re.DOTALL)
        blocks = [block.splitlines() for block in pattern.findall((SOURCE_DIR / document).read_text())]
        self.assertGreater(sum(map(len, blocks)), 5)
        return [result for block in blocks for result in self.run_block(block)]

    def run_block(self, commands: list[str]) -> list[tuple[str, str]]:
        """Runs the commands without a pause, as a user who pastes the block does, who then waits for the programs."""
        started = set(self.programs.values())
        results = [(command, self.run_command(command)) for command in commands]
        for name, program in self.programs.items():
            if program not in started:
                self.wait_until_ready(name, program)
        return results

    def run_command(self, line: str) -> str:
        line = line.replace("29536", self.port)
        if line.startswith("export "):
            name, value = line.removeprefix("export ").split("=", 1)
            self.variables[name] = value.replace("$PWD", str(self.folder))
            return ""
        if line.endswith(" &"):
            return self.start(line.removesuffix(" &"))
        result = subprocess.run(["bash", "-c", line], cwd=self.folder, env=self.variables, capture_output=True, text=True,
                                timeout=1700)
        self.assertEqual(result.returncode, 0, f"{line}:\n{result.stdout}{result.stderr}")
        return result.stdout

    def start(self, command: str) -> str:
        self.programs[Path(command.split()[0]).name] = Program(command, self.folder, self.variables)
        return ""

    def wait_until_ready(self, name: str, program: Program) -> None:
        program.wait_for(READY.get(name, "state pre-operational, .*"))
