#!/usr/bin/env python3
"""Sources, documents and generated files use the terms of the field.

    words_test.py SOURCE_DIR

Each row is a phrase that must not occur, and what to write instead. Documents that quote manuals are not searched.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

PHRASES = {
    r"(?<!there )(?<!that )\b(?:is|are) no (?!longer\b|limit\b|more\b|\[)[a-z]": "is not a ...",
    r"\bstands (?:twice|there|here|without|behind|nowhere)\b": "is duplicate; exists; is",
    r"\btaken for rw\b": "assuming rw",
    r"\bof no use without\b": "requires ...",
    r"\bfollows the node-ID\b": "node-ID-dependent",
    r"\bof no fixed length\b": "variable-length",
    r"\bbehind the \]": "after the section header",
    r"\bwhat is wrong with data sheets\b": "check EDS, DCF and XDD files",
    r"\bwhom it breaks\b": "report breaking changes",
    r"\brooms\b": "modules",
    r"\bthe way of the data\b": "data flow",
    r"\bspeaks against\b": "why it is rejected",
    r"\bwhat of it changes\b|\bwhat changes of it\b": "values in RAM",
    r"\beats (?:frames|time)\b": "consumes",
    r"\bgives way\b": "is overwritten",
    r"\bputs down\b": "records",
    r"\bgoes the longer way\b": "takes the slow path",
    r"\bfor ever\b": "indefinitely",
    r"\bhas no words\b": "cannot express",
    r"\bmost_(?!similar\b)[a-z]+": "max_...",
    r"\btold_u\d+\b": "read_only_...",
    r"\bpatience\(\)": "timeout()",
}
FILES = ("*.hpp", "*.cpp", "*.md", "*.mustache", "*.cmake", "*CMakeLists.txt", "*.sh", "*.json")
SKIPPED = re.compile(r"^(docs/developers/manuals\.md|tests/manuals/\d+\.md|tests/layout/|tests/traces/|tests/golden/fixtures/|examples/master/package)")


def main() -> int:
    source_dir = Path(sys.argv[1]).resolve()
    listed = subprocess.run(["git", "-C", source_dir, "ls-files", *FILES], capture_output=True, text=True)
    if listed.returncode != 0:
        print("SKIPPED: the folder is not a git repository")
        return 77
    problems = []
    for name in filter(lambda name: not SKIPPED.match(name), listed.stdout.splitlines()):
        path = source_dir / name
        if not path.is_file():
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
            problems += [f"{name}:{number}: \"{found[0]}\": write \"{better}\"" for phrase, better in PHRASES.items()
                         if (found := re.search(phrase, line, re.IGNORECASE))]
    print("\n".join(problems))
    print(f"{len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
