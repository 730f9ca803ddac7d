#!/usr/bin/env python3
"""All of edsc writes to standard error with write_to_stderr() and print_to_stderr(), which do not fail.

    standard_error_test.py SOURCE_DIR

Other functions throw, or end the program with SIGPIPE, where standard error is closed or full.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

FOLDERS = ("generator", "bus", "cli")
BUILD_TOOLS = {"generator/text/make_code_pages.cpp"}  # a program of its own, for the build
WRITERS = {f"generator/system/{folder}standard_streams.cpp" for folder in ("", "windows/")}
TEXT = re.compile(r'//.*|"(?:\\.|[^"\\])*"')
QUESTION = re.compile(r"\b(?:is_terminal|on)\(stderr\)")  # asks for a property of the stream
STREAM = re.compile(r"\b(?:stderr|cerr|clog|STDERR_FILENO|perror)\b")
DESCRIPTORS = WRITERS | {"generator/system/run_program.cpp"}  # connect the descriptor


def misuses(text: str) -> list[int]:
    """The numbers of the lines that name standard error other than to ask for its properties."""
    return [number for number, line in enumerate(text.splitlines(), 1)
            if STREAM.search(QUESTION.sub("", TEXT.sub("", line)))]


def main() -> int:
    source_dir = Path(sys.argv[1])
    assert misuses('fmt::print(stderr, "x");') and misuses('  stderr,\n') and misuses("std::cerr << 1;")
    assert not misuses('const char* word = "stderr";  // to stderr') and not misuses("color.on(stderr)")
    problems = 0
    for folder in FOLDERS:
        for path in sorted((source_dir / folder).rglob("*.[ch]pp")):
            name = str(path.relative_to(source_dir))
            if name in BUILD_TOOLS | DESCRIPTORS:
                continue
            for number in misuses(path.read_text(encoding="utf-8")):
                print(f"{name}:{number}: use print_to_stderr() or write_to_stderr()")
                problems += 1
    print(f"{problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
