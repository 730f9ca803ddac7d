#!/usr/bin/env python3
"""Makes small changes in the sources, one at a time, and counts the changes that a test detects.

    mutation.py --against REF         all mutants of the lines changed since the git reference
    mutation.py --sample N --seed S   N mutants of the whole runtime and generator

All mutants are compiled into one copy of the project, and the environment variable EDSC_MUTANT selects the active one.
The exit code is 0 if the score is at least --min-score, 1 if it is lower, 2 if there is no score: a program fails without a
mutant, or the copy does not compile.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from pathlib import Path

from equivalents import find_equivalent, read_equivalents
from mutated_build import BuildError, MutatedBuild
from points import Mutation
from project import Area, Program, Project, edsc_project
from runs import Baseline, BaselineError, Result, Runner
from selection import select_changed, select_sample

MAX_JOBS = 2
NOTICED, UNNOTICED = ("killed",), ("survived", "not reached")


def parse_arguments(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", metavar="REF", help="mutate the lines changed since this git reference")
    parser.add_argument("--sample", metavar="N", type=int, help="mutate N places in all files")
    parser.add_argument("--seed", metavar="S", type=int, default=1, help="seed of the sample (default: 1)")
    parser.add_argument("--per-file", metavar="N", type=int, default=5, help="maximum per file of a sample (default: 5)")
    parser.add_argument("--programs", metavar="NAME,NAME", help="run only these of the programs that test the files")
    parser.add_argument("--under", metavar="FOLDER,FOLDER", default="",
                        help="only files of these folders, such as generator/decode")
    parser.add_argument("--min-score", metavar="PERCENT", type=float, default=95, help="lowest score for exit code 0")
    parser.add_argument("--jobs", metavar="N", type=int, default=MAX_JOBS, choices=range(1, MAX_JOBS + 1))
    parser.add_argument("--folder", type=Path, default=Path("build/mutation"),
                        help="for the mutated copy and its build")
    parser.add_argument("--edsc", type=Path, help="generates the code for tests of the runtime (default: built again)")
    parser.add_argument("--output", type=Path, help="JSON file for the results (default: report.json in the folder)")
    parsed = parser.parse_args(arguments)
    if (parsed.against is None) == (parsed.sample is None):
        parser.error("expected either --against or --sample")
    return parsed


class Report:
    def __init__(self, project: Project):
        self.project = project
        self.dropped: list[Mutation] = []
        self.known = read_equivalents(project.equivalents) if project.equivalents else []
        self.results: list[Result] = []
        self.equivalent: list[tuple[Result, str]] = []

    def source(self, mutation: Mutation) -> bytes:
        return (self.project.root / mutation.file).read_bytes()

    def add(self, result: Result) -> None:
        row = None
        if result.outcome in UNNOTICED:
            row = find_equivalent(result.mutation, self.source(result.mutation), self.known)
        if row is not None:
            self.equivalent.append((result, row.reason))
        else:
            self.results.append(result)

    def counts(self) -> Counter:
        return Counter(result.outcome for result in self.results)

    def score(self) -> float:
        """Percentage of detected mutants. Equivalent ones, and those that only the compiler evaluates, do not count."""
        counts = self.counts()
        noticed, unnoticed = (sum(counts[outcome] for outcome in outcomes) for outcomes in (NOTICED, UNNOTICED))
        return 100.0 * noticed / (noticed + unnoticed) if noticed + unnoticed else 100.0

    def show(self, result: Result, remark: str = "") -> None:
        mutation = result.mutation
        line, mutated = mutation.changed_line(self.source(mutation))
        print(f"{mutation.file}:{mutation.line}: {mutation.operator}: {result.outcome}{remark}")
        print(f"  - {line}\n  + {mutated}")

    def print(self) -> None:
        print()
        for result in sorted(self.results, key=lambda result: result.number):
            if result.outcome not in NOTICED:
                self.show(result, f" ({', '.join(result.programs)})" if result.programs else "")
        for result, why in self.equivalent:
            self.show(result, f", known as equivalent: {why}")
        counts = self.counts()
        print(f"\n{self.score():.1f} % of the mutants were noticed: {counts['killed']} killed, "
              f"{counts['survived']} survived, {counts['not reached']} not reached by any program")
        print(f"not counted: {len(self.equivalent)} equivalent, {counts['compile time']} evaluated by the compiler, "
              f"{len(self.dropped)} did not compile")

    def as_json(self) -> dict:
        equivalent = [(result, "equivalent", why) for result, why in self.equivalent]
        counted = [(result, result.outcome, result.how) for result in self.results]
        return {
            "score": round(self.score(), 2),
            "counts": {**self.counts(), "equivalent": len(self.equivalent), "does not compile": len(self.dropped)},
            "mutants": [self.row(result, outcome, how) for result, outcome, how in
                        sorted(counted + equivalent, key=lambda row: row[0].number)],
        }

    def row(self, result: Result, outcome: str, how: str) -> dict:
        line, mutated = result.mutation.changed_line(self.source(result.mutation))
        return {"number": result.number, "file": result.mutation.file, "line": result.mutation.line,
                "operator": result.mutation.operator, "before": line, "after": mutated, "outcome": outcome,
                "how": how, "programs": result.programs}


def select_programs(area: Area, mutants: dict[int, Mutation], names: str | None) -> list[Program]:
    """Returns the programs that test one of the mutated files."""
    files = {mutation.file for mutation in mutants.values()}
    wanted = names.split(",") if names is not None else [program.name for program in area.programs]
    return [program for program in area.programs
            if program.name in wanted and any(program.is_for(file) for file in files)]


def run_mutants(build: MutatedBuild, programs: list[Program], jobs: int, scratch: Path, report: Report) -> None:
    runner = Runner(build.source, build.build, scratch)
    baselines: list[Baseline] = []
    for program in programs:
        baselines.append(runner.baseline(program))
        print(f"{program.name}: passes in {baselines[-1].seconds:.1f} s, reaches {len(baselines[-1].reached)} mutants",
              flush=True)
    for done, result in enumerate(runner.try_mutants(build.mutants, baselines, jobs), 1):
        mutation = result.mutation
        print(f"[{done:4}/{len(build.mutants)}] {result.outcome:12} {mutation.file}:{mutation.line} {mutation.operator}"
              f"{' by ' + result.how if result.how else ''}", flush=True)
        report.add(result)


def run_area(project: Project, area: Area, mutants: dict[int, Mutation], arguments: argparse.Namespace,
             report: Report) -> None:
    folder = arguments.folder.resolve() / area.name
    scratch = folder / "scratch"
    scratch.mkdir(parents=True, exist_ok=True)
    programs = select_programs(area, mutants, arguments.programs)
    build = MutatedBuild(project, area, folder, mutants, arguments.jobs)
    build.make(programs)
    report.dropped += build.dropped
    run_mutants(build, programs, arguments.jobs, scratch, report)


def run(project: Project, arguments: argparse.Namespace) -> int:
    under = tuple(arguments.under.split(","))
    if arguments.against is not None:
        mutations = select_changed(project, arguments.against, under)
    else:
        mutations = select_sample(project, arguments.sample, arguments.seed, under, arguments.per_file)
    print(f"{len(mutations)} mutants in {len({mutation.file for mutation in mutations})} files", flush=True)
    if not mutations:
        return 0
    numbered = dict(enumerate(mutations, 1))
    report = Report(project)
    try:
        for area in project.areas:
            mutants = {number: mutation for number, mutation in numbered.items() if area.has(mutation.file)}
            if mutants:
                run_area(project, area, mutants, arguments, report)
    except (BuildError, BaselineError) as error:
        print(error, file=sys.stderr)
        return 2
    report.print()
    (arguments.output or arguments.folder / "report.json").write_text(json.dumps(report.as_json(), indent=2) + "\n")
    return 0 if report.score() >= arguments.min_score else 1


def main() -> int:
    arguments = parse_arguments(None)
    return run(edsc_project(Path(__file__).resolve().parents[2], arguments.edsc), arguments)


if __name__ == "__main__":
    sys.exit(main())
