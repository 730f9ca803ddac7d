#!/usr/bin/env python3
"""The commands of docs/networks.md, "From three EDS files to a running network", in their order.

    first_network_test.py SOURCE_DIR BUILD_DIR [unittest arguments]

BUILD_DIR takes the place of build/demo. The bus has a free port.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

SOURCE_DIR, BUILD_DIR = (Path(argument).resolve() for argument in sys.argv[1:3])
NODES = ("outputs", "inputs", "encoder")
PATIENCE = 600.0  # maximum seconds until a line, on a busy machine
BLOCK = re.compile(r"<!-- run by: tests/package/first_network_test\.py -->\n```sh\n(.*?)```", re.DOTALL)


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


class FirstNetwork(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="edsc-network-"))
        self.addCleanup(shutil.rmtree, self.folder)
        for name in ("eds", "examples"):
            shutil.copytree(SOURCE_DIR / name, self.folder / name)
        (self.folder / "build").mkdir()
        (self.folder / "build/demo").symlink_to(BUILD_DIR)
        self.variables = {**os.environ, "PATH": f"{BUILD_DIR / 'generator'}{os.pathsep}{os.environ['PATH']}"}
        if shutil.which("ccache"):
            self.variables |= {"CMAKE_CXX_COMPILER_LAUNCHER": "ccache", "CCACHE_BASEDIR": str(self.folder),
                               "CXX": "ccache c++"}
        self.port = str(free_port())
        self.programs: dict[str, Program] = {}

    def tearDown(self) -> None:
        for program in reversed(self.programs.values()):
            program.end()

    def run_line(self, line: str) -> str:
        line = line.replace("29536", self.port)
        if line.startswith("export "):
            name, value = line.removeprefix("export ").split("=", 1)
            self.variables[name] = value
            return ""
        if line.endswith(" &"):
            self.start(line.removesuffix(" &"))
            return ""
        variables = self.variables
        if line.startswith("cmake"):
            variables = {name: value for name, value in variables.items() if name != "CXX"}
        result = subprocess.run(["bash", "-c", line], cwd=self.folder, env=variables, capture_output=True, text=True,
                                timeout=1700)
        self.assertEqual(result.returncode, 0, f"{line}:\n{result.stdout}{result.stderr}")
        return result.stdout

    def start(self, command: str) -> None:
        program = Program(command, self.folder, self.variables)
        name = Path(command.split()[0]).name
        self.programs[name] = program
        if name == "line":
            for node in NODES:
                program.wait_for(f"{node}: booted")
        else:
            program.wait_for("socketcand:.*" if name == "edsc" else "state pre-operational, .*")

    def test_the_commands_in_their_order(self) -> None:
        output = {}
        for block in BLOCK.findall((SOURCE_DIR / "docs/networks.md").read_text()):
            for line in block.splitlines():
                output[line] = self.run_line(line)
        self.assertIn("3 of 3 nodes configured, started", "".join(output.values()))
        self.assertIn("4 of 4 nodes Operational at the end", "".join(output.values()))
        self.check_that_a_node_is_booted_again()

    def check_that_a_node_is_booted_again(self) -> None:
        """As the document says: it is reported as lost, and booted again."""
        master = self.programs["line"]
        self.programs["can_2057c"].process.send_signal(signal.SIGKILL)
        master.wait_for("outputs: lost, last state .*")
        self.programs.pop("can_2057c").end()
        self.run_line("build/demo/examples/nodes/can_2057c $BUS --node-id 1 &")
        master.wait_for("outputs: booted", 2)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
