#!/usr/bin/env python3
"""`edsc check` has few warnings for EDS files of vendors, most of which describe devices that work: half of the files at most two.

    warnings_test.py SOURCE_DIR EDSC

The corpus is not part of this repository (see corpus_test.py); without it the test is skipped.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus_test import SECONDS, find_corpus, paths_in  # noqa: E402
from support.compilers import SKIPPED, in_parallel  # noqa: E402

MAX_MEDIAN = 2


def count_warnings(job: tuple[Path, Path]) -> int:
    edsc, path = job
    result = subprocess.run([edsc, "check", "--format", "json", path], capture_output=True, timeout=SECONDS)
    return sum(one["severity"] == "warning" for one in json.loads(result.stdout)["diagnostics"])


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    corpus = find_corpus(source_dir)
    if corpus is None:
        print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
        return SKIPPED
    counts = in_parallel(count_warnings, [(edsc, corpus / path) for path in paths_in(corpus)])
    median = statistics.median(counts)
    print(f"{len(counts)} files: median {median} warnings, {counts.count(0)} files without a warning")
    return 1 if median > MAX_MEDIAN else 0


if __name__ == "__main__":
    sys.exit(main())
