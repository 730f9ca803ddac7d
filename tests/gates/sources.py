#!/usr/bin/env python3
"""Each source and each public header compiles alone without a warning, and clang-tidy has no findings.

    sources.py SOURCE_DIR BUILD_DIR [--all]

Without --all, only what differs from origin/main, or what the last commit changed if nothing differs: the changed files and
those that include them, nearest first, at most `MAX_ALONE`, and clang-tidy of the changed folders; nothing if more than `MAX_ALONE` sources differ. All of them if there is no
origin/main. BUILD_DIR is a build with Ninja; what is up to date in it is not built again.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

MAX_ALONE = 40  # about a minute on two cores
ROOTS = ("generator", "bus", "cli", "runtime/include")
INCLUDE = re.compile(r'^#include ["<]([^">]+)[">]', re.MULTILINE)


def git(source_dir: Path, *arguments: str) -> list[str] | None:
    result = subprocess.run(["git", "-C", source_dir, *arguments], capture_output=True, text=True)
    return result.stdout.splitlines() if result.returncode == 0 else None


def changed_files(source_dir: Path) -> set[str] | None:
    """Returns the files that differ from the common ancestor with origin/main, with those that git does not track yet."""
    base = git(source_dir, "merge-base", "HEAD", "origin/main")
    if not base:
        return None
    if base == git(source_dir, "rev-parse", "HEAD"):  # as in a fresh clone: the last commit
        base = git(source_dir, "rev-parse", "HEAD~1") or base
    return {*git(source_dir, "diff", "--name-only", base[0]), *git(source_dir, "ls-files", "--others", "--exclude-standard")}


def includers(source_dir: Path) -> dict[str, set[str]]:
    """Returns, for each file, those that include it."""
    found: dict[str, set[str]] = defaultdict(set)
    for root in ROOTS:
        for path in (source_dir / root).rglob("*.[ch]pp"):
            name = path.relative_to(source_dir).as_posix()
            for include in INCLUDE.findall(path.read_text(encoding="utf-8")):
                for other in (*(source_dir / root / include for root in ROOTS), path.parent / include):
                    if other.is_file():
                        found[other.resolve().relative_to(source_dir).as_posix()].add(name)
                        break
    return found


def by_distance(changed: set[str], includers_of: dict[str, set[str]]) -> list[str]:
    """Returns the changed files, then those that include them, then those that include these."""
    found = sorted(changed)
    known = set(found)
    for name in found:
        further = sorted(includers_of[name] - known)
        known.update(further)
        found.extend(further)
    return found


def folder_of(name: str) -> str:
    return "runtime" if name.startswith("runtime/") else name.rpartition("/")[0]


def selected(source_dir: Path, rows: list[list[str]], changed: set[str]) -> list[str]:
    """Returns the files to build. A command of cli/ is one row for clang-tidy, a folder of the libraries is one row."""
    alone = {sources[0]: file for kind, file, *sources in rows if kind == "alone"}
    if len(changed.intersection(alone)) > MAX_ALONE:
        print(f"more than {MAX_ALONE} sources differ: ./test.sh sources compiles all")
        return []
    near = [name for name in by_distance(changed, includers(source_dir)) if name in alone]
    if len(near) > MAX_ALONE:
        print(f"{MAX_ALONE} of {len(near)} sources that include what changed; ./test.sh sources compiles all")
    folders = {folder_of(name) for name in changed if name.endswith((".cpp", ".hpp"))}
    tidy = [file for kind, file, *sources in rows if kind == "tidy" and (
        not changed.isdisjoint(sources) or (len(sources) > 1 and folders.intersection(map(folder_of, sources))))]
    return [*(alone[name] for name in near[:MAX_ALONE]), *tidy]


def main() -> int:
    source_dir, build_dir = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    files = ["gate_sources"]
    changed = None if "--all" in sys.argv[3:] else changed_files(source_dir)
    if changed is not None:
        lines = (build_dir / "gates/targets.tsv").read_text(encoding="utf-8").splitlines()
        files = selected(source_dir, [line.split("\t") for line in lines], changed)
    if not files:
        print("no source to compile")
        return 0
    return subprocess.run(["cmake", "--build", build_dir, "--target", *files, "--", "-k", "0"]).returncode


if __name__ == "__main__":
    sys.exit(main())
