#!/usr/bin/env python3
"""Every EDS of the corpus resolves to a device; broken.tsv lists the few that are unusable.

    resolve_test.py SOURCE_DIR EDSC

- `edsc dump` ends with 0 and shows the device.
- For a broken file it ends with 1, and shows the rest of the device with --keep-going.
- A file that `edsc generate` rejects is generated with --keep-going, and the result compiles.

The corpus is not part of this repository (see corpus_test.py); without it the test is skipped.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus_test import compile_headers, find_corpus, paths_in  # noqa: E402
from support.compilers import GCC, SKIPPED, in_parallel  # noqa: E402

SECONDS = 600
MOST_BROKEN = 6


def read_broken() -> dict[str, str]:
    lines = Path(__file__).with_name("broken.tsv").read_text(encoding="utf-8").splitlines()
    return dict(line.split("\t") for line in lines if line and not line.startswith("#"))


def run(edsc: Path, *arguments: object) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([edsc, *map(str, arguments)], capture_output=True, timeout=SECONDS)


def check_dump(edsc: Path, path: Path, is_broken: bool) -> str:
    """Returns the problem, or an empty text."""
    result = run(edsc, "dump", path)
    if result.returncode != (1 if is_broken else 0):
        return f"edsc dump ends with {result.returncode}"
    if is_broken:
        result = run(edsc, "dump", path, "--keep-going")
    return "" if result.stdout and json.loads(result.stdout)["objects"] else "edsc dump shows no device"


def check_keep_going(edsc: Path, path: Path, output: Path, runtime: Path) -> str:
    if run(edsc, "generate", path, "-o", output).returncode == 0:
        return ""  # corpus_test.py compiles it
    if run(edsc, "generate", path, "-o", output, "--name", "device", "--keep-going").returncode != 0:
        return "edsc generate --keep-going fails"
    error = compile_headers(output, runtime) if GCC.installed else ""
    return f"what --keep-going makes does not compile: {error}" if error else ""


def check_file(job: tuple[Path, Path, str, bool, Path, Path]) -> str:
    edsc, corpus, path, is_broken, output, runtime = job
    try:
        return check_dump(edsc, corpus / path, is_broken) or check_keep_going(edsc, corpus / path, output, runtime)
    except subprocess.TimeoutExpired:
        return f"not done after {SECONDS} s"


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    corpus = find_corpus(source_dir)
    if corpus is None:
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
        return SKIPPED
    broken = read_broken()
    paths = paths_in(corpus)
    with tempfile.TemporaryDirectory() as scratch:
        jobs = [(edsc, corpus, path, path in broken, Path(scratch) / str(number), source_dir / "runtime/include")
                for number, path in enumerate(paths)]
        problems = in_parallel(check_file, jobs)
    for path, problem in zip(paths, problems):
        if problem:
            print(f"{path}: {problem}")
    wrong = sum(bool(problem) for problem in problems)
    print(f"{len(paths)} files: {len(broken)} broken as listed, {wrong} wrong")
    return 1 if wrong or len(broken) > MOST_BROKEN or not broken.keys() <= set(paths) else 0


if __name__ == "__main__":
    sys.exit(main())
