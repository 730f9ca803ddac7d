#!/usr/bin/env python3
"""The C++ sources have the format of .clang-format, as clang-format 14 writes it.

    format.py SOURCE_DIR [--fix] [FILE]...

Lists the places that differ; --fix rewrites the files instead. FILE, relative to SOURCE_DIR: only these, or the
sources in this folder. Files that .clang-format-ignore names are left as they are.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch
from os import cpu_count
from pathlib import Path

BATCH = 50
SUFFIXES = (".cpp", ".hpp", ".h", ".c")
VIOLATION = re.compile(r"^(.+?:\d+):\d+: error: code should be clang-formatted", re.MULTILINE)


def sources(source_dir: Path, files: list[str]) -> list[str]:
    """Returns the files that git tracks or would track, of the given ones if any are, without the ignored ones."""
    listed = subprocess.run(["git", "-C", source_dir, "ls-files", "--cached", "--others", "--exclude-standard",
                             *(files or (f"*{suffix}" for suffix in SUFFIXES))], capture_output=True, text=True, check=True)
    lines = (source_dir / ".clang-format-ignore").read_text(encoding="utf-8").splitlines()
    ignored = [line for line in lines if line and not line.startswith("#")]
    return [name for name in sorted(set(listed.stdout.splitlines()))
            if name.endswith(SUFFIXES) and (source_dir / name).is_file() and not any(fnmatch(name, pattern) for pattern in ignored)]


def run(program: str, source_dir: Path, names: list[str], *options: str) -> tuple[list[str], str]:
    """Returns the places that differ, and what the program says if it fails in another way."""
    result = subprocess.run([program, "--style=file", *options, *names], cwd=source_dir, capture_output=True, text=True)
    places = VIOLATION.findall(result.stderr)
    return places, result.stderr if result.returncode != 0 and not places else ""


def main() -> int:
    source_dir, fix = Path(sys.argv[1]).resolve(), "--fix" in sys.argv[2:]
    files = [argument for argument in sys.argv[2:] if argument != "--fix"]
    if not (source_dir / ".git").exists():
        print("SKIPPED: the folder is not a git repository")
        return 77
    program = shutil.which("clang-format-14")
    if program is None:
        print("SKIPPED: clang-format-14 of Debian 12 is missing; other versions format some lines differently")
        return 77
    names = sources(source_dir, files)
    batches = [names[start:start + BATCH] for start in range(0, len(names), BATCH)]
    options = ["-i"] if fix else ["--dry-run", "--Werror"]
    with ThreadPoolExecutor(cpu_count()) as pool:
        results = list(pool.map(lambda batch: run(program, source_dir, batch, *options), batches))
    places = [place for found, _ in results for place in found]
    failures = "".join(failure for _, failure in results)
    print("\n".join(dict.fromkeys(places)) + failures)
    if fix or not places:
        print(f"{len(names)} files" + (" formatted" if fix else " have the format of .clang-format"))
        return 1 if failures else 0
    files = len({place.rpartition(":")[0] for place in places})
    print(f"{files} of {len(names)} files have another format: run tests/gates/format.py . --fix")
    return 1


if __name__ == "__main__":
    sys.exit(main())
