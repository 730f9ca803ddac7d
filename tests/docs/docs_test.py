#!/usr/bin/env python3
"""The documents are correct: their commands succeed, their code is in files that are built and tested, the targets of their
links exist, and the output of commands is as printed.

    docs_test.py SOURCE_DIR EDSC [--cold-demo]

In README.md, CONTRIBUTING.md, CHANGELOG.md and all *.md of docs
- each line of a ```sh block is run in a copy of the repository, with edsc in the PATH. `./demo.sh` runs there; it uses the
  build of EDSC, and with --cold-demo it builds. `./test.sh` is not run, but must exist.
- a block under `<!-- run by: path -->` is run by that test, which names the document.
- a block under `<!-- path -->` is part of that file, character by character; under `<!-- all of path -->` it is the whole file.
- a block under `<!-- output: command -->` is the output of the command; under `<!-- output on Debian 12: command -->` with the compilers
  of Debian 12.
- the syntax of a ```python block, which is for another library, is checked; so is that of a ```json block.
- the commands, actions and options of `edsc` in an indented block, which needs a bus or a file of the reader, exist.
- the heading that a link names exists.
A page for users does not link to a file that is not in the package.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.debian import is_debian  # noqa: E402

OF_DEBIAN_12 = "output on Debian 12: "
BLOCK = re.compile(r"(?:<!-- (?P<mark>[^>]+) -->\n)?```(?P<language>\w*)\n(?P<text>.*?)```", re.DOTALL)
LINK = re.compile(r"\]\((?!https?:)([^)#]*)(?:#([^)]*))?\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
INDENTED_COMMAND = re.compile(r"^    edsc (.*)$", re.MULTILINE)
OPTION = re.compile(r"(?<=\s)--?[a-z][a-z-]*")
NOT_RUN_HERE = {"./test.sh"}


def run(command: str, folder: Path, environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, timeout=3400)


def check_commands(document: Path, text: str, folder: Path, environment: dict[str, str]) -> list[str]:
    problems = []
    for line in text.splitlines():
        program = folder / shlex.split(line)[0]
        if line in NOT_RUN_HERE:
            if not os.access(program, os.X_OK):
                problems.append(f"{document}: {line}: not an executable program")
            continue
        result = run(line, folder, environment)
        if result.returncode != 0:
            problems.append(f"{document}: `{line}` failed with exit code {result.returncode}:\n{result.stdout}{result.stderr}")
    return problems


def check_python(document: Path, text: str) -> list[str]:
    try:
        compile(text, str(document), "exec")
    except SyntaxError as error:
        return [f"{document}: line {error.lineno} of a block: {error.msg}"]
    return []


def check_json(document: Path, text: str) -> list[str]:
    try:
        json.loads(text)
    except json.JSONDecodeError as error:
        return [f"{document}: line {error.lineno} of a block: {error.msg}"]
    return []


def check_indented_commands(document: Path, text: str, folder: Path, environment: dict[str, str]) -> list[str]:
    problems = []
    for line in INDENTED_COMMAND.findall(text):
        command = line.split()[0]
        if command.startswith("-"):
            continue
        action = line.split()[1] if command == "network" and line.split()[1].islower() else ""
        printed = run(f"edsc {command} {action} --help", folder, environment)
        if printed.returncode != 0:
            problems.append(f"{document}: `edsc {command} {action}` does not exist")
        known = set(OPTION.findall(printed.stdout.replace(",", " ")))
        problems += [f"{document}: `edsc {line}`: unknown option {one}" for one in OPTION.findall(line) if one not in known]
    return problems


def check_block(document: Path, block: re.Match[str], source: Path, folder: Path, environment: dict[str, str]) -> list[str]:
    mark, text = block["mark"], block["text"]
    if mark and mark.startswith(OF_DEBIAN_12) and not is_debian(12):
        return []
    if mark and mark.startswith(("output: ", OF_DEBIAN_12)):
        printed = run(mark.partition(": ")[2], folder, environment).stdout
        return [] if printed == text else [f"{document}: {mark} differs; it prints:\n{printed}"]
    if mark and mark.startswith("run by: "):
        named = document.name in (source / mark.removeprefix("run by: ")).read_text(encoding="utf-8")
        return [] if named else [f"{document}: {mark}: the test does not name the document"]
    if mark and mark.startswith("all of "):
        is_file = text == (source / mark.removeprefix("all of ")).read_text(encoding="utf-8")
        return [] if is_file else [f"{document}: the block under {mark} differs from that file"]
    if mark:
        found = text in (source / mark).read_text(encoding="utf-8")
        return [] if found else [f"{document}: the block under {mark} is not in that file"]
    if block["language"] == "sh":
        return check_commands(document, text, folder, environment)
    if block["language"] == "python":
        return check_python(document, text)
    if block["language"] == "json":
        return check_json(document, text)
    return []


def anchors_of(document: Path) -> set[str]:
    """The anchors of its headings, as GitHub makes them."""
    headings = HEADING.findall(BLOCK.sub("", document.read_text(encoding="utf-8")))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in headings}


def is_installed(path: Path) -> bool:
    """Whether the package has this file of the repository, as cmake/EdscInstall.cmake states it."""
    if path.parts[:2] in (("docs", "developers"), ("docs", "site")):
        return False
    return path.parts[0] in ("docs", "examples", "eds") or str(path) in ("README.md", "CHANGELOG.md")


def check_links(document: Path, text: str, source: Path) -> list[str]:
    problems = []
    for name, anchor in LINK.findall(BLOCK.sub("", text)):
        target = (source / document).parent / name if name else source / document
        is_for_users = document.parts[:2] != ("docs", "developers") and document.name != "CONTRIBUTING.md"
        if is_for_users and not is_installed(target.resolve().relative_to(source)):
            problems.append(f"{document}: {name} is not in the package: write its name without a link")
        elif not target.exists():
            problems.append(f"{document}: the target of link {name} does not exist")
        elif anchor and target.suffix == ".md" and anchor not in anchors_of(target):
            problems.append(f"{document}: {target.name} does not have the heading of link #{anchor}")
    return problems


def main() -> int:
    source, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    documents = [Path("README.md"), Path("CONTRIBUTING.md"), Path("CHANGELOG.md"), *sorted(
        path.relative_to(source) for path in (source / "docs").rglob("*.md"))]
    problems: list[str] = []
    blocks = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "edsc"
        shutil.copytree(source, folder, ignore=shutil.ignore_patterns("build", ".git", "out"))
        environment = {**os.environ, "PATH": f"{edsc.parent}{os.pathsep}{os.environ['PATH']}"}
        if "--cold-demo" not in sys.argv:
            environment["EDSC_DEMO_BUILD"] = str(edsc.parents[1])
        for document in documents:
            text = (source / document).read_text(encoding="utf-8")
            problems += check_links(document, text, source)
            problems += check_indented_commands(document, BLOCK.sub("", text), folder, environment)
            for block in BLOCK.finditer(text):
                blocks += 1
                problems += check_block(document, block, source, folder, environment)
    print("\n".join(problems))
    print(f"{len(documents)} documents, {blocks} blocks, {len(problems)} problems")
    return 1 if problems or blocks == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
