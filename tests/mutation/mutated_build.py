"""Copies a project, writes mutations into the copy and builds it. A mutation that does not compile is dropped."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

from points import Mutation
from project import Area, Program, Project
from schemata import Schemata, write_schemata

MESSAGE = re.compile(r"^(?P<path>[^\s:][^:]*):(?P<line>\d+):(?P<column>\d+): (?P<kind>fatal error|error|note):", re.M)
REQUIRED_FROM = re.compile(r"^(?P<path>[^\s:][^:]*):(?P<line>\d+):(?P<column>\d+):\s+(required|in .constexpr.)", re.M)


class BuildError(Exception):
    """The copy does not compile, and a mutation is not the reason."""


def write_if_changed(path: Path, contents: bytes) -> None:
    """Keeps the time of an unchanged file, so that files that include it are not rebuilt."""
    if path.is_file() and path.read_bytes() == contents:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(contents)


class MutatedBuild:
    def __init__(self, project: Project, area: Area, folder: Path, mutants: dict[int, Mutation], jobs: int):
        self.project = project
        self.area = area
        self.source = folder / "source"
        # As many folders below the sources as those of the presets: paths in the compiler's cache are relative.
        self.build = self.source / "build" / "mutated"
        self.mutants = mutants  # by number; those that do not compile are removed
        self.dropped: list[Mutation] = []
        self.jobs = jobs
        self.schemata: dict[str, Schemata] = {}

    def make(self, programs: Iterable[Program]) -> None:
        self.copy_project()
        self.write_mutants({mutation.file for mutation in self.mutants.values()})
        self.configure()
        self.check_syntax()
        targets = sorted({target for program in programs for target in program.targets})
        command = ["cmake", "--build", str(self.build), "-j", str(self.jobs), "--target", *targets, "--", "-k", "0"]
        while (output := self.run(command)) is not None:
            self.drop(output)

    def copy_project(self) -> None:
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                cwd=self.project.root, check=True, capture_output=True).stdout
        names = {name.decode() for name in listed.split(b"\0") if name}
        mutated = {mutation.file for mutation in self.mutants.values()}
        for name in names - mutated:
            path = self.project.root / name
            if path.is_file():
                write_if_changed(self.source / name, path.read_bytes())
                shutil.copymode(path, self.source / name)
        for path in self.source.rglob("*"):
            name = str(path.relative_to(self.source))
            if path.is_file() and name not in names and not name.startswith("build/"):
                path.unlink()

    def write_mutants(self, files: Iterable[str]) -> None:
        for file in files:
            mutants = {number: mutation for number, mutation in self.mutants.items() if mutation.file == file}
            self.schemata[file] = write_schemata((self.project.root / file).read_bytes(), mutants)
            write_if_changed(self.source / file, self.schemata[file].text)

    def configure(self) -> None:
        output = self.run(["cmake", "-S", str(self.source), "-B", str(self.build), "-G", "Ninja",
                           *self.area.cmake_options])
        if output is not None:
            raise BuildError(output)

    def check_syntax(self) -> None:
        """Compiles each mutated header alone: faster than to find the same errors in every file that includes it."""
        for file in sorted(file for file in self.schemata if file.endswith(".hpp")):
            command = ["g++", *self.project.compile_arguments(self.source), "-w", "-xc++", "-fsyntax-only",
                       str(self.source / file)]
            while self.schemata[file].places and (output := self.run(command)) is not None:
                self.drop(output)

    def drop(self, output: str) -> None:
        """Removes the mutations that the compiler messages refer to, and writes their files again."""
        errors = [match for match in MESSAGE.finditer(output) if match["kind"] != "note"]
        notes = [match for match in MESSAGE.finditer(output) if match["kind"] == "note"]
        for messages in (errors, [*notes, *REQUIRED_FROM.finditer(output)]):
            numbers = defaultdict(set)
            for message in messages:
                file = self.file_of(message["path"])
                if file is not None:
                    numbers[file] |= self.schemata[file].numbers_at(int(message["line"]), int(message["column"]))
            named = {number for in_file in numbers.values() for number in in_file}
            if named:
                self.dropped += [self.mutants.pop(number) for number in sorted(named)]
                self.write_mutants([file for file in numbers if numbers[file]])
                print(f"{len(named)} mutants do not compile", flush=True)
                return
        raise BuildError(output[-4000:])

    def file_of(self, path: str) -> str | None:
        """Returns the mutated file that a compiler message refers to."""
        absolute = (self.build / path).resolve()
        if not absolute.is_relative_to(self.source.resolve()):
            return None
        file = str(absolute.relative_to(self.source.resolve()))
        return file if file in self.schemata else None

    def run(self, command: list[str]) -> str | None:
        """Runs a command; returns its output if it fails, otherwise None."""
        done = subprocess.run(command, cwd=self.build if self.build.is_dir() else None, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        return done.stdout if done.returncode != 0 else None
