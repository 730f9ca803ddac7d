#!/usr/bin/env python3
"""The code generated from each EDS becomes a device that passes the conformance test, in simulated time.

    conform_test.py SOURCE_DIR EDSC WORK_DIR [--compiler CXX] [--flags FLAGS] [--launcher "PROGRAM ARGUMENT..."]
                    [--only TEXT]... [--case PATTERN]... [--each N] [--dynamic PROGRAM]

Each EDS, DCF and XDD of the corpus, of eds/ and of the tests' fixtures becomes code that is compiled with a node, several of
them into one program, and `edsc conform --level all` tests it. A failure that the file causes is not a failure of the device:
the report names a rule, and `edsc check` must report this rule for the file, too. A file that `edsc generate` rejects is
generated with --keep-going; such a device may reject its own values: its failures and the values that are not restored are
only counted, but the run must reach its end. Deviations that NAME.deviations.json beside a file declares must fail.

With --dynamic (tests/bus/device/dynamic_device.cpp) each file also runs as a node without a compiler, as with `edsc node`, which
must get the same verdict in each case; DYNAMIC_DIFFERENCES has the exceptions, each with its reason, and an exception that does not differ is a problem.

The corpus is in the folder EDSC_CORPUS, or in ../shared/eds-corpus beside the repository; without a corpus only the files of
the repository are tested. To test one file, and all of them:

    conform_test.py . build/test/generator/edsc build/conform --only cpd.eds
    conform_test.py . build/test/generator/edsc build/conform

CTest tests each fourth file of the corpus: a run with all of them takes a quarter of an hour.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import os
import re
import resource
import shlex
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import SKIPPED, in_parallel  # noqa: E402
from support.made_fixtures import names_eds  # noqa: E402

NODE_ID = 5
SHEETS_PER_PROGRAM = 12
FLAGS = "-std=c++20 -O0 -w -fno-exceptions -fno-rtti"
SHOWN = 6  # maximum of printed problems per file
# Cases whose verdict may differ without a compiler: (text in the path of the file, case, reason).
DYNAMIC_DIFFERENCES: tuple[tuple[str, str, str], ...] = (
    ("every_service.eds", "4.10", "multiplex PDOs need generated code, and a note says so"),
    ("mapped_strings.eds", "3.3", "PDOs with strings need generated code, and a note says so"),
    ("mapped_strings.eds", "3.4", "the same"),
    ("mapped_strings.eds", "3.5", "the same"),
    ("mapped_strings.eds", "9.3", "the same"),
    ("301.eds", "5.6", "1003h:00 is UNSIGNED32, and a note says that no service uses it"),
    ("Easy-ak_v1.30.eds", "5.6", "the same"),
)
MAIN = """#include <canopen_sim/simulated_device.hpp>

extern const std::span<const canopen::SimulatedDevice> devices;

int main(int argc, char** argv) { return canopen::simulate_devices(argc, argv, devices); }
"""


@dataclass
class Job:
    path: Path
    title: str
    name: str = ""  # its namespace; empty if nothing is generated
    program: Path | None = None
    refused: bool = False
    verdicts: Counter = field(default_factory=Counter)
    problems: list[str] = field(default_factory=list)
    by_sheet: int = 0  # failures that edsc check explains


def corpus_of(source_dir: Path) -> list[Job]:
    corpus = Path(os.environ.get("EDSC_CORPUS", source_dir.parent / "shared/eds-corpus"))
    if not (corpus / "manifest.tsv").is_file():
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder. Only the files of the repository are tested")
        return []
    with (corpus / "manifest.tsv").open(newline="", encoding="utf-8") as manifest:
        return [Job(corpus / row["path"], row["path"]) for row in csv.DictReader(manifest, delimiter="\t")]


def own_sheets(source_dir: Path, work: Path) -> list[Job]:
    found = [*sorted((source_dir / "eds").glob("*.eds")), *sorted((source_dir / "tests/fixtures").glob("*.eds"))]
    return [*(Job(path, str(path.relative_to(source_dir))) for path in found), Job(names_eds(work), "tests/fixtures/names.eds")]


def node_id_of(path: Path) -> int:
    """Returns the node-ID of a DCF, whose values are for that node; 5 for an EDS."""
    found = re.search(rb"(?im)^\s*NodeID\s*=\s*(0x[0-9a-f]+|[0-9]+)", path.read_bytes())
    node_id = int(found[1], 0) if found and path.suffix.lower() == ".dcf" else 0
    return node_id if 1 <= node_id <= 127 else NODE_ID


class Driver:
    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments
        self.edsc = arguments.edsc.resolve()
        self.source_dir = arguments.source_dir.resolve()
        self.work = arguments.work_dir.resolve()
        self.work.mkdir(parents=True, exist_ok=True)
        self.compiler = [*shlex.split(arguments.launcher), *shlex.split(arguments.compiler), *shlex.split(arguments.flags)]
        # Relative to the working folder of the compiler, so that ccache also finds results of another clone.
        self.include = [f"-I{os.path.relpath(self.source_dir / 'runtime/include', self.work)}", "-Igenerated"]

    def generate(self, job: Job) -> None:
        job.name = "d" + hashlib.sha256(job.title.encode()).hexdigest()[:10]
        command = [self.edsc, "generate", job.path, "-o", self.work / "generated", "--name", job.name, "--color", "never"]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600)
        device = self.work / "generated" / job.name / "device.hpp"
        if result.returncode == 1:
            job.refused = True
            device.unlink(missing_ok=True)  # from an earlier run
            result = subprocess.run([*command, "--keep-going"], capture_output=True, text=True, errors="replace", timeout=600)
        if result.returncode not in (0, 1):
            job.problems.append(f"edsc generate ends with {result.returncode}")
        if not device.is_file():
            job.name = ""

    def write_and_compile(self, name: str, text: str) -> str:
        """Returns the errors of the compiler, or an empty text."""
        (self.work / f"{name}.cpp").write_text(text, encoding="utf-8")
        command = [*self.compiler, *self.include, "-c", f"{name}.cpp", "-o", f"{name}.o"]
        result = subprocess.run(command, cwd=self.work, capture_output=True, text=True, errors="replace")
        return "" if result.returncode == 0 else result.stderr or f"exit code {result.returncode}"

    def program_of(self, jobs: list[Job], name: str) -> Path | None:
        """Returns None if it does not compile."""
        lines = ["#include <canopen_sim/simulated_node.hpp>", *(f"#include <{job.name}/device.hpp>" for job in jobs)]
        rows = ", ".join(f'{{"{job.name}", canopen::make_simulated_node<{job.name}::Device>}}' for job in jobs)
        lines += [f"static constexpr canopen::SimulatedDevice all[] = {{{rows}}};",
                  "extern const std::span<const canopen::SimulatedDevice> devices;",
                  "const std::span<const canopen::SimulatedDevice> devices{all};"]
        error = self.write_and_compile(name, "\n".join(lines) + "\n")
        if not error:
            link = [*self.compiler, f"{name}.o", "main.o", "-o", name]
            result = subprocess.run(link, cwd=self.work, capture_output=True, text=True)
            error = result.stderr if result.returncode else ""
        if error and len(jobs) == 1:
            jobs[0].problems.append("does not compile: " + first_error(error))
        return None if error else self.work / name

    def build(self, jobs: list[Job]) -> None:
        name = "conform_" + hashlib.sha256(" ".join(job.name for job in jobs).encode()).hexdigest()[:10]
        if program := self.program_of(jobs, name):
            for job in jobs:
                job.program = program
        elif len(jobs) > 1:
            for job in jobs:
                self.build([job])

    def run(self, job: Job) -> None:
        if report := self.report_of(job, f"{job.program}@{node_id_of(job.path)},{job.name}", job.name):
            job.problems += self.problems_in(report, job)
            if self.arguments.dynamic:
                job.problems += self.dynamic_problems(job, report)

    def report_of(self, job: Job, device: str, name: str) -> dict | None:
        """Tests a simulated device; returns the report, or None if there is none, which is a problem of the job."""
        report = self.work / f"{name}.json"
        report.unlink(missing_ok=True)
        command = [self.edsc, "conform", f"simulated:{device}", str(node_id_of(job.path)), job.path, "--level", "all", "--quiet",
                   "--json", report, *(f"--only={case}" for case in self.arguments.case)]
        deviations = job.path.with_suffix(".deviations.json")
        if deviations.is_file():
            command += ["--deviations", deviations]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600)
        if not report.is_file():
            job.problems.append(f"{name}: edsc conform ends with {result.returncode}: {result.stderr.strip()[-300:]}")
            return None
        return json.loads(report.read_text(encoding="utf-8"))

    def dynamic_problems(self, job: Job, generated: dict) -> list[str]:
        """Returns the verdicts that the device gets as generated code, but not as a node without a compiler."""
        script = self.work / f"{job.name}_dynamic"  # a simulated device has no arguments
        script.write_text(f'#!/bin/sh\nexec {shlex.quote(str(self.arguments.dynamic.resolve()))} {shlex.quote(str(job.path))}\n')
        script.chmod(0o755)
        dynamic = self.report_of(job, f"{script}@{node_id_of(job.path)}", script.name)
        if dynamic is None:
            return []
        expected, got = ({case["id"]: case for case in report["cases"]} for report in (generated, dynamic))
        allowed = {case for text, case, _ in DYNAMIC_DIFFERENCES if job.title.endswith("/" + text)}
        nothing = {"verdict": "not run", "got": ""}
        differing = {case: f"expected {one['verdict']}; got {other['verdict']}: {other['got']}"
                     for case in sorted(expected.keys() | got.keys())
                     if (one := expected.get(case, nothing))["verdict"] != (other := got.get(case, nothing))["verdict"]}
        problems = [f"{case} without a compiler: {text}" for case, text in differing.items() if case not in allowed]
        if not self.arguments.case:
            problems += [f"{case} without a compiler: the exception of DYNAMIC_DIFFERENCES is not needed"
                         for case in sorted(allowed - differing.keys())]
        return problems

    def problems_in(self, report: dict, job: Job) -> list[str]:
        problems = []
        failed = [case for case in report["cases"] if case["verdict"] == "failed"]
        rules = self.rules_of(job) if any(case["rule"] for case in failed) else set()
        for case in failed:
            if case["rule"] in rules:
                job.by_sheet += 1
                continue
            if job.refused:
                continue
            rule = f" [{case['rule']}, which edsc check does not report]" if case["rule"] else ""
            problems.append(f"{case['id']} {case['title']}: expected {case['expected']}; got {case['got']}{rule}")
        for case in report["cases"]:
            job.verdicts[case["verdict"]] += 1
            if not job.refused:
                problems += [f"{case['id']} not restored: {text}" for text in case["not_restored"]]
        problems += [f"unused deviation: {text}" for text in report["unused_deviations"]]
        if report["ended_early"]:
            problems.append(report["ended_early"])
        return problems

    def rules_of(self, job: Job) -> set[str]:
        """Returns the rules that edsc check reports for the file."""
        command = [self.edsc, "check", "--format", "json", job.path]
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=600)
        return {diagnostic["rule"] for diagnostic in json.loads(result.stdout)["diagnostics"]}


def cpu_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


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
    parser.add_argument("--only", action="append", default=[], help="files whose path contains this text, or one of several")
    parser.add_argument("--each", type=int, default=1, metavar="N", help="each Nth file of the corpus")
    parser.add_argument("--dynamic", type=Path, metavar="PROGRAM", help="runs an EDS without a compiler: compare the verdicts")
    parser.add_argument("--case", action="append", default=[], help="cases, as for edsc conform --only")
    return parser.parse_args()


def main() -> int:
    arguments = arguments_of()
    driver = Driver(arguments)
    jobs = [job for job in [*own_sheets(driver.source_dir, driver.work), *corpus_of(driver.source_dir)[::arguments.each]]
            if not arguments.only or any(text in job.title for text in arguments.only)]
    if not jobs:
        print(f"SKIPPED: no file whose path contains {' or '.join(arguments.only)}")
        return SKIPPED
    if error := driver.write_and_compile("main", MAIN):
        print(error)
        return 1
    in_parallel(driver.generate, jobs)
    generated = [job for job in jobs if job.name]
    groups = [generated[first:first + SHEETS_PER_PROGRAM] for first in range(0, len(generated), SHEETS_PER_PROGRAM)]
    in_parallel(driver.build, groups)
    before = cpu_seconds()
    in_parallel(driver.run, [job for job in generated if job.program])
    spent = cpu_seconds() - before
    total: Counter = Counter()
    for job in jobs:
        total += job.verdicts
        how = " (rejected, --keep-going)" if job.refused else ""
        passed = f"{job.verdicts['passed']} passed" if job.name else "nothing is generated"
        if failed := job.verdicts["failed"]:
            passed += f", {failed} failed, {job.by_sheet} of them caused by the file"
        if not job.problems:
            print(f"{job.title}{how}: {passed}")
        else:
            print(f"{job.title}{how}: {len(job.problems)} problems")
            for problem in job.problems[:SHOWN]:
                print(f"    {problem[:400]}")
    conform = sum(not job.problems for job in generated)
    refused = sum(job.refused for job in generated)
    print(f"{conform} of {len(generated)} devices conform ({refused} of them in spite of errors); {len(jobs)} files; "
          + ", ".join(f"{count} {verdict}" for verdict, count in sorted(total.items()))
          + f"; {spent:.1f} s of CPU after compilation")
    return 1 if any(job.problems for job in jobs) else 0


if __name__ == "__main__":
    sys.exit(main())
