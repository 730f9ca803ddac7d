#!/usr/bin/env python3
"""Every sheet runs: what edsc generates from it lives on a bus as CiA 301 says, and sends nothing else.

    live_test.py SOURCE_DIR EDSC WORK_DIR [--compiler CXX] [--flags FLAGS] [--launcher "PROGRAM ARGUMENT..."]
                 [--only TEXT]... [--frames]

Each EDS, DCF and XDD of the corpus, of eds/ and of the tests' fixtures is generated and compiled with a node, several of
them to a program. The node lives on a virtual bus in simulated time under three node-IDs, that of a DCF under its own:
power-on, SDO, heartbeat, EMCY, SYNC, PDOs, NMT commands, resets (live/life.py). What it may send is read from the sheet by
live/sheet.py, which has nothing of edsc. A sheet that `edsc generate` refuses is tried with --keep-going: what is generated
then has to live too.

The corpus lies in the folder EDSC_CORPUS, or in ../shared/eds-corpus beside the repository; without one the sheets of the
repository are tested alone. One sheet by hand, with all frames:

    live_test.py . build/test/generator/edsc build/live --only cpd.eds --frames
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import os
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parent))
from live.life import Life  # noqa: E402
from live.sheet import read_sheet  # noqa: E402
from support.compilers import SKIPPED, in_parallel  # noqa: E402

NODE_IDS = (1, 5, 127)
SHEETS_PER_PROGRAM = 12
FLAGS = "-std=c++20 -O0 -w -fno-exceptions -fno-rtti"
SHOWN = 6  # problems of one sheet


@dataclass
class Job:
    path: Path
    title: str
    name: str = ""  # its namespace
    refused: bool = False
    frames: int = 0  # that it has sent
    problems: list[str] = field(default_factory=list)


def corpus_of(source_dir: Path) -> list[Job]:
    corpus = Path(os.environ.get("EDSC_CORPUS", source_dir.parent / "shared/eds-corpus"))
    if not (corpus / "manifest.tsv").is_file():
        print("SKIPPED: no corpus; EDSC_CORPUS names one. The sheets of the repository are tested alone")
        return []
    with (corpus / "manifest.tsv").open(newline="", encoding="utf-8") as manifest:
        return [Job(corpus / row["path"], row["path"]) for row in csv.DictReader(manifest, delimiter="\t")]


def own_sheets(source_dir: Path) -> list[Job]:
    found = [*sorted((source_dir / "eds").glob("*.eds")), *sorted((source_dir / "tests/fixtures").glob("*.eds"))]
    return [Job(path, str(path.relative_to(source_dir))) for path in found]


class Driver:
    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments
        self.source_dir = arguments.source_dir.resolve()
        self.work = arguments.work_dir.resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.compiler = [*shlex.split(arguments.launcher), *shlex.split(arguments.compiler), *shlex.split(arguments.flags)]
        # Relative to the folder where the compiler runs, so that ccache finds it for another clone.
        self.include = [f"-I{os.path.relpath(self.source_dir / folder, self.work)}" for folder in
                        ("runtime/include", "tests/corpus/live")] + ["-Igenerated"]

    def generate(self, job: Job) -> None:
        job.name = "d" + hashlib.sha256(job.title.encode()).hexdigest()[:10]
        command = [self.arguments.edsc.resolve(), "generate", job.path, "-o", self.work / "generated", "--name", job.name,
                   "--color", "never"]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600)
        device = self.work / "generated" / job.name / "device.hpp"
        if result.returncode == 1:
            job.refused = True
            device.unlink(missing_ok=True)  # that of an earlier run
            result = subprocess.run([*command, "--keep-going"], capture_output=True, text=True, errors="replace", timeout=600)
        if result.returncode not in (0, 1):
            job.problems.append(f"edsc generate ends with {result.returncode}")
        if not device.is_file():
            job.name = ""

    def compile(self, source: str, target: str) -> str:
        """What the compiler says when it fails."""
        command = [*self.compiler, *self.include, "-c", source, "-o", target]
        result = subprocess.run(command, cwd=self.work, capture_output=True, text=True, errors="replace")
        return "" if result.returncode == 0 else result.stderr or f"exit code {result.returncode}"

    def program_of(self, jobs: list[Job], name: str) -> Path | None:
        """None: it does not compile."""
        lines = ['#include "live_node.hpp"']
        lines += [f"#include <{job.name}/device.hpp>" for job in jobs]
        lines += [f'static live::Registration {job.name}_registration{{"{job.name}", live::make<{job.name}::Device>}};'
                  for job in jobs]
        source = self.work / f"{name}.cpp"
        source.write_text("\n".join(lines) + "\n", encoding="utf-8")
        error = self.compile(source.name, f"{name}.o")
        if not error:
            link = [*self.compiler, f"{name}.o", "player.o", "-o", name]
            result = subprocess.run(link, cwd=self.work, capture_output=True, text=True)
            error = result.stderr if result.returncode else ""
        if error and len(jobs) == 1:
            jobs[0].problems.append("does not compile: " + first_error(error))
        return None if error else self.work / name

    def run_group(self, group: tuple[int, list[Job]]) -> None:
        number, jobs = group
        name = "live_" + hashlib.sha256(" ".join(job.name for job in jobs).encode()).hexdigest()[:10]
        if program := self.program_of(jobs, name):
            self.run(program, jobs)
        elif len(jobs) > 1:
            for job in jobs:
                self.run_group((number, [job]))

    def run(self, program: Path, jobs: list[Job]) -> None:
        lives = [(job, life) for job in jobs for life in self.lives_of(job)]
        script = "".join("\n".join(life.lines) + "\n" for _, life in lives)
        result = subprocess.run([program], input=script, capture_output=True, text=True, errors="replace", timeout=600)
        logs = re.split(r"^device .*\n", result.stdout, flags=re.MULTILINE)[1:]
        if self.arguments.frames:
            for (job, life), log in zip(lives, logs):
                self.show(job, life, log)
        for number, (job, life) in enumerate(lives):
            if number < len(logs):
                job.frames += sum(line[:1].isdigit() for line in logs[number].splitlines())
                job.problems += [f"node {life.node_id}: {problem}" for problem in life.judge(logs[number].splitlines())]
        if result.returncode != 0 or len(logs) != len(lives):
            job, life = lives[max(len(logs) - 1, 0)]
            job.problems.append(f"node {life.node_id}: the program ends with {result.returncode}: {result.stderr[-2000:]}")

    @staticmethod
    def lives_of(job: Job) -> list[Life]:
        sheet = read_sheet(job.path)
        departs = job.path.with_suffix(".options.json").is_file()
        node_ids = (sheet.commissioned,) if sheet.commissioned else NODE_IDS
        return [Life(sheet, job.name, node_id, lenient=job.refused, departs=departs) for node_id in node_ids]

    @staticmethod
    def show(job: Job, life: Life, log: str) -> None:
        print(f"{job.title}, node {life.node_id}")
        for line in log.splitlines():
            print(f"  {life.steps[int(line[2:])].name}" if line.startswith("= ") else f"    {line}")


def first_error(text: str) -> str:
    return next((line for line in text.splitlines() if "error:" in line), text[:300])


def arguments_of() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("work_dir", type=Path)
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--flags", default=FLAGS)
    parser.add_argument("--launcher", default="")
    parser.add_argument("--only", action="append", default=[], help="sheets whose path holds this, or one of several")
    parser.add_argument("--frames", action="store_true", help="print all that the devices send")
    return parser.parse_args()


def main() -> int:
    arguments = arguments_of()
    driver = Driver(arguments)
    jobs = [job for job in [*own_sheets(driver.source_dir), *corpus_of(driver.source_dir)]
            if not arguments.only or any(text in job.title for text in arguments.only)]
    if not jobs:
        print(f"SKIPPED: no sheet whose path holds {' or '.join(arguments.only)}")
        return SKIPPED
    in_parallel(driver.generate, jobs)
    generated = [job for job in jobs if job.name]
    player = driver.source_dir / "tests/corpus/live/player.cpp"
    if error := driver.compile(os.path.relpath(player, driver.work), "player.o"):
        print(error)
        return 1
    groups = [generated[first:first + SHEETS_PER_PROGRAM] for first in range(0, len(generated), SHEETS_PER_PROGRAM)]
    in_parallel(driver.run_group, list(enumerate(groups)))
    for job in jobs:
        how = " (refused, --keep-going)" if job.refused else ""
        if not job.problems:
            print(f"{job.title}{how}: {f'lives, {job.frames} frames' if job.name else 'nothing is generated'}")
        else:
            print(f"{job.title}{how}: {len(job.problems)} problems")
            for problem in job.problems[:SHOWN]:
                print(f"    {problem}")
    alive = sum(not job.problems for job in generated)
    refused = sum(job.refused for job in generated)
    print(f"{alive} of {len(generated)} devices live ({refused} of them in spite of errors); {len(jobs)} sheets, "
          f"node-IDs {', '.join(map(str, NODE_IDS))}")
    return 1 if any(job.problems for job in jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
