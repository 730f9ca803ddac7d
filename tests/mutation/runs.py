"""Runs programs with one mutant each and reports the results."""

from __future__ import annotations

import os
import re
import resource
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path

from points import Mutation
from project import Program

# A program hangs if it takes much longer than without a mutant, on a machine that may be busier now.
HANG_FACTOR = 10
HANG_SECONDS = 60
MAX_MEMORY = 4 << 30
MAX_FILE_SIZE = 2 << 30  # bytes; one test makes a sparse file of more than 1 GiB
FAILED_TEST = re.compile(r"^\[  FAILED  \] ([\w./]+)|^(?:FAIL|ERROR): (\S+)", re.M)


@dataclass
class Baseline:
    """Behaviour of a program without a mutant."""

    program: Program
    seconds: float
    reached: set[int]


@dataclass
class Result:
    number: int
    mutation: Mutation
    outcome: str  # killed, survived, not reached, compile time
    how: str = ""  # if killed: the program, and a test, a signal or "hangs"
    programs: list[str] = field(default_factory=list)  # programs that ran


class BaselineError(Exception):
    """A program fails without a mutant."""


class Runner:
    def __init__(self, source: Path, build: Path, scratch: Path):
        self.folders = {"source": str(source), "build": str(build)}
        self.scratch = scratch

    def baseline(self, program: Program) -> Baseline:
        with tempfile.NamedTemporaryFile(dir=self.scratch, prefix="reached") as reached:
            start = time.monotonic()
            failure = self.run(program, 0, None, Path(reached.name))
            if failure is not None:
                raise BaselineError(f"{program.name} fails without a mutant: {failure}")
            numbers = {int(line) for line in Path(reached.name).read_text().split()}
            return Baseline(program, time.monotonic() - start, numbers)

    def try_mutant(self, number: int, mutation: Mutation, baselines: list[Baseline]) -> Result:
        ran = []
        for baseline in baselines:
            if number not in baseline.reached or not baseline.program.is_for(mutation.file):
                continue
            ran.append(baseline.program.name)
            failure = self.run(baseline.program, number, HANG_SECONDS + HANG_FACTOR * baseline.seconds)
            if failure is not None:
                return Result(number, mutation, "killed", f"{baseline.program.name}: {failure}", ran)
        if ran:
            return Result(number, mutation, "survived", "", ran)
        return Result(number, mutation, "compile time" if mutation.in_constexpr else "not reached")

    def try_mutants(self, mutants: dict[int, Mutation], baselines: list[Baseline], jobs: int) -> Iterator[Result]:
        with ThreadPoolExecutor(jobs) as pool:
            runs = [pool.submit(self.try_mutant, number, mutation, baselines) for number, mutation in mutants.items()]
            for run in as_completed(runs):
                yield run.result()

    def run(self, program: Program, number: int, limit: float | None, reached: Path | None = None) -> str | None:
        """Returns how the program failed, or None."""
        command = [part.format(**self.folders) for part in program.command]
        with tempfile.TemporaryDirectory(dir=self.scratch) as folder, tempfile.TemporaryFile() as output:
            environment = {**os.environ, "EDSC_MUTANT": str(number), "TMPDIR": folder, "TEST_TMPDIR": folder,
                           "PYTHONDONTWRITEBYTECODE": "1"}
            environment.pop("EDSC_MUTANT_REACHED", None)
            if reached is not None:
                environment["EDSC_MUTANT_REACHED"] = str(reached)
            process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=subprocess.STDOUT, start_new_session=True, preexec_fn=limit_resources)
            try:
                code = process.wait(limit)
            except subprocess.TimeoutExpired:
                return "hangs"
            finally:
                end_group(process)
            if code == 0:
                return None
            output.seek(0)
            return reason(code, output.read().decode(errors="replace"))


def limit_resources() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (MAX_FILE_SIZE, MAX_FILE_SIZE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def end_group(process: subprocess.Popen) -> None:
    """Also ends the processes that the program has started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def reason(code: int, output: str) -> str:
    failed = FAILED_TEST.search(output)
    if failed:
        return failed[1] or failed[2]
    if code < 0:
        return signal.Signals(-code).name
    last = output.strip().splitlines()[-1:] or [""]
    return f"exit code {code}: {last[0][:200]}"
