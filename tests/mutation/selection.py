"""Selects the mutations to try: all of the lines that differ from a git reference, or a sample."""

from __future__ import annotations

import random
import re
import subprocess
from collections import defaultdict
from pathlib import Path

from points import Mutation, find_mutations
from project import Project

HUNK = re.compile(r"^@@ -\S+ \+(\d+)(?:,(\d+))? @@")


def mutations_of(project: Project, file: str) -> list[Mutation]:
    with_variables = project.area_of(file).mutates_constexpr_variables
    return find_mutations(project.root, file, project.compile_arguments(project.root), with_variables)


def git(root: Path, *arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=root, check=True, capture_output=True, text=True).stdout


def changed_lines(root: Path, reference: str, folders: list[str]) -> dict[str, set[int]]:
    """Returns the lines of the working tree that are not in the reference."""
    # Compared with the common ancestor: later changes of the reference are not changes of this tree.
    base = git(root, "merge-base", reference, "HEAD").strip()
    diff = git(root, "diff", "--unified=0", "--no-color", "--no-ext-diff", base, "--", *folders)
    lines: dict[str, set[int]] = defaultdict(set)
    file = ""
    for line in diff.splitlines():
        if line.startswith("+++ "):
            file = line.removeprefix("+++ ").removeprefix("b/")
        elif match := HUNK.match(line):
            first, count = int(match[1]), int(match[2] or 1)
            lines[file] |= set(range(first, first + count))
    return lines


def select_changed(project: Project, reference: str, under: tuple[str, ...]) -> list[Mutation]:
    lines = changed_lines(project.root, reference, [folder for area in project.areas for folder in area.folders])
    return [mutation for file in project.files(under) if lines.get(file)
            for mutation in mutations_of(project, file) if mutation.line in lines[file]]


def select_sample(project: Project, count: int, seed: int, under: tuple[str, ...], per_file: int) -> list[Mutation]:
    """Draws files, weighted by their number of lines, then lines of each file, then one mutation of each line.

    Finding the mutations of a file takes seconds, and so does compiling it; therefore several are of one file."""
    generator = random.Random(seed)
    files = project.files(under)
    weights = {file: len((project.root / file).read_bytes().splitlines()) for file in files}
    sample: list[Mutation] = []
    while files and len(sample) < count:
        file = generator.choices(files, [weights[name] for name in files])[0]
        files.remove(file)
        by_line = defaultdict(list)
        for mutation in mutations_of(project, file):
            by_line[mutation.line].append(mutation)
        wanted = min(per_file, count - len(sample), len(by_line))
        sample += [generator.choice(by_line[line]) for line in sorted(generator.sample(sorted(by_line), wanted))]
    return sorted(sample, key=lambda mutation: (mutation.file, mutation.start, mutation.text))
