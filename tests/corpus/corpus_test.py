#!/usr/bin/env python3
"""EDS files as vendors ship them: edsc generates code from nearly all of them and reports errors in the others.

    corpus_test.py SOURCE_DIR EDSC [--compile-each N]

--compile-each N: the compiler reads what is generated for each Nth file.
The corpus is not part of this repository. It is in the folder EDSC_CORPUS, or in ../shared/eds-corpus beside the
repository: a manifest.tsv whose column `path` contains the names of the files. Without a corpus the test is skipped.
"""

from __future__ import annotations

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import GCC, SKIPPED, compile_only, in_parallel  # noqa: E402

AT_LEAST = 135
SECONDS = 600
XML = (".xdd", ".xdc", ".xpd")
ERROR = re.compile(r": error: ")
PLACED_ERROR = re.compile(r":\d+:\d+: error: ")
WHOLE_FILE = re.compile(r": error: .*\[(?:empty-file|no-objects|xml-file)\]$", re.MULTILINE)  # without a line


@dataclass(frozen=True)
class Outcome:
    path: str
    exit_code: int | None = None
    first_error: str = ""
    problem: str = ""  # something that must never happen, whatever the file contains

    @property
    def fine(self) -> bool:
        return self.exit_code == 0 and not self.problem


def find_corpus(source_dir: Path) -> Path | None:
    corpus = Path(os.environ.get("EDSC_CORPUS", source_dir.parent / "shared/eds-corpus"))
    return corpus if (corpus / "manifest.tsv").is_file() else None


def paths_in(corpus: Path) -> list[str]:
    with (corpus / "manifest.tsv").open(newline="", encoding="utf-8") as manifest:
        paths = [row["path"] for row in csv.DictReader(manifest, delimiter="\t")]
    return [path for path in paths if not path.lower().endswith(XML)]


def first_error_in(output: str) -> str:
    return next((line for line in output.splitlines() if ERROR.search(line)), "").rpartition("/")[2]


def outcome_of(path: str, exit_code: int, stderr: str) -> Outcome:
    error = first_error_in(stderr)
    problem = ""
    if exit_code not in (0, 1):
        problem = f"exit code {exit_code}"
    elif exit_code == 0 and error:
        problem = "exit code 0 in spite of an error"
    elif exit_code == 1 and not PLACED_ERROR.search(stderr) and not WHOLE_FILE.search(stderr):
        problem = "exit code 1 without an error that has a line"
    return Outcome(path, exit_code, error, problem)


def compile_headers(output: Path, runtime: Path) -> str:
    """Returns the first error of the compiler, or an empty text."""
    source = output / "all.cpp"
    source.write_text("#include <device/description.hpp>\n#include <device/device.hpp>\n")
    result = compile_only(GCC, source, (output, runtime))
    if result.returncode == 0:
        return ""
    return next((line for line in result.stderr.splitlines() if "error:" in line), result.stderr[:200])


def run_file(job: tuple[Path, str, Path, Path, Path | None]) -> Outcome:
    edsc, path, corpus, output, runtime = job
    command = [edsc, "generate", corpus / path, "-o", output, "--name", "device", "--color", "never"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=SECONDS)
    except subprocess.TimeoutExpired:
        return Outcome(path, problem=f"not done after {SECONDS} s")
    outcome = outcome_of(path, result.returncode, result.stderr)
    if outcome.fine and runtime is not None and GCC.installed:
        error = compile_headers(output, runtime)
        return Outcome(path, 0, error, "what is generated does not compile" if error else "")
    return outcome


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--compile-each", type=int, default=1)
    arguments = parser.parse_args()
    source_dir, edsc = arguments.source_dir.resolve(), arguments.edsc.resolve()
    corpus = find_corpus(source_dir)
    if corpus is None:
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
        return SKIPPED
    paths = paths_in(corpus)
    with tempfile.TemporaryDirectory() as scratch:
        runtime = source_dir / "runtime/include"
        jobs = [(edsc, path, corpus, Path(scratch) / str(number), runtime if number % arguments.compile_each == 0 else None)
                for number, path in enumerate(paths)]
        outcomes = in_parallel(run_file, jobs)
    for outcome in outcomes:
        if not outcome.fine:
            print(f"{outcome.path}: exit code {outcome.exit_code}: {outcome.problem or outcome.first_error}")
            if outcome.problem and outcome.first_error:
                print(f"    {outcome.first_error}")
    fine = sum(outcome.fine for outcome in outcomes)
    print(f"{fine} of {len(outcomes)}")
    return 1 if fine < AT_LEAST or any(outcome.problem for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
