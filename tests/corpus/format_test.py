#!/usr/bin/env python3
"""`edsc format` keeps the content of an EDS: checks of the canonical form with the EDS files of this repository and of vendors.

    format_test.py SOURCE_DIR EDSC

- The canonical form of the canonical form is itself, and `--check` confirms it.
- It describes the same device: `edsc dump` differs only in lines.
- It contains the text of each comment, each text value and each line of an unknown section.
- `--dcf --node-id 5` describes the device that `edsc dump --node-id 5` shows for the EDS.

The vendors' EDS files are not part of this repository; without them (see corpus_test.py) that part is skipped.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus_test import find_corpus, paths_in  # noqa: E402
from support.compilers import SKIPPED, in_parallel  # noqa: E402

SECONDS = 600
NODE_ID = "5"
ERROR = re.compile(r": error: ")
KNOWN_SECTION = re.compile(
    r"fileinfo|deviceinfo|dummyusage|comments|devicecomm?issioning|(mandatory|optional|manufacturer)objects"
    r"|(m[0-9]+fixed)?[0-9a-f]{1,4}(sub[0-9a-f]{1,2}|name|value|denotation|objectlinks)?"
    r"|tools|tool[0-9]+|dynamicchannels|(supported|connected)modules"
    r"|m[0-9]+(moduleinfo|comments|fixedobjects|subextends|subext[0-9a-f]{1,4})", re.IGNORECASE)


@dataclass(frozen=True)
class Outcome:
    path: Path
    refused: str = ""  # the reader's first error
    problems: tuple[str, ...] = ()


def run(edsc: Path, *arguments: object) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([edsc, *map(str, arguments), "--color", "never"], capture_output=True, timeout=SECONDS)


def ascii_lines(content: bytes) -> list[str]:
    """Returns stripped lines without characters outside ASCII, because the canonical form has another encoding."""
    text = content.decode("latin-1").encode("ascii", "ignore").decode("ascii")
    return [line.strip(" \t\x1a") for line in re.split(r"\r\n|\n|\r", text)]


def comments(content: bytes) -> Counter[str]:
    """Returns the text of each comment."""
    found = (re.sub(r"^[;#]\s*", "", line, count=1) for line in ascii_lines(content) if line[:1] in (";", "#"))
    return Counter(text.strip() for text in found)


def unknown_lines(content: bytes) -> list[str]:
    """Returns title and entries of sections that CiA 306 does not define."""
    lines, title = [], ""
    for line in ascii_lines(content):
        if line.startswith("["):
            title = line[1:].partition("]")[0].strip(" \t")
            unknown = KNOWN_SECTION.fullmatch(title) is None
            lines += [f"[{title}]"] if unknown else []
        elif title and unknown and "=" in line and line[0] not in ";#=":
            key, _, value = line.partition("=")
            lines.append(f"{key.rstrip()}={value.lstrip()}")
    return lines


def texts(content: bytes) -> set[str]:
    """Returns entries with a text value, not with a number, formula or CiA 306 keyword. The first of duplicates is used."""
    found, titles, keys = set(), set(), set()
    for line in ascii_lines(content):
        if line.startswith("["):
            title = line[1:].partition("]")[0].strip(" \t").lower()
            keys = set() if title not in titles else None
            titles.add(title)
        key, equals, value = line.partition("=")
        key, value = key.strip().lower(), value.strip(" \t")
        if keys is None or not equals or line[0] in ";#[=" or key in keys:
            continue
        keys.add(key)
        if re.fullmatch(r"|[-+0-9$].*|.*[;#].*|const|w?o|r[owr]?w?", value, re.IGNORECASE) is None:
            found.add(f"{key}={value}")
    return found


def without_places(view: object) -> object:
    if isinstance(view, dict):
        return {key: without_places(value) for key, value in view.items()
                if key not in ("line", "column", "source") and not key.endswith("_line")}
    if isinstance(view, list):
        return [without_places(element) for element in view]
    return view


def without_commissioning(view: object) -> object:
    """Removes what a DCF has and an EDS does not have."""
    if not isinstance(view, dict):
        return view
    file_info = {key: value for key, value in (view.get("file_info") or {}).items() if key != "last_eds"}
    return {**view, "file_info": file_info, "commissioning": None}


def dump(edsc: Path, path: Path, *options: str | Path) -> object:
    """Returns the device, or the exit code if there is none."""
    result = run(edsc, "dump", path, "--keep-going", *options)
    return without_places(json.loads(result.stdout)) if result.stdout else result.returncode


def options_of(path: Path) -> tuple[str | Path, ...]:
    """Returns what a copy of an EDS needs to describe the same device: the options file beside the EDS, if it exists."""
    options = path.with_suffix(".options.json")
    return ("--options", options) if options.exists() else ()


def configured(view: object) -> object:
    """Removes the sections that only a DCF has, and sets the values with which the device starts."""
    if not isinstance(view, dict):
        return view
    return {key: effective_values(value) for key, value in view.items() if key not in ("commissioning", "file_info")}


def effective_values(view: object) -> object:
    """Replaces each DefaultValue by its ParameterValue."""
    if isinstance(view, dict):
        effective = {key: effective_values(value) for key, value in view.items()}
        if "parameter_value" in effective:
            effective["default_value"] = effective.pop("parameter_value")
        return effective
    if isinstance(view, list):
        return [effective_values(element) for element in view]
    return view


def check_canonical(edsc: Path, path: Path, formatted: bytes, folder: Path) -> list[str]:
    problems = []
    again = folder / path.name
    again.write_bytes(formatted)
    if run(edsc, "format", again).stdout != formatted:
        problems.append("the canonical form has another canonical form")
    if run(edsc, "format", again, "--check").returncode != 0:
        problems.append("--check does not take the canonical form for canonical")
    if dump(edsc, path) != dump(edsc, again, *options_of(path)):
        problems.append("the canonical form is another device")
    missing = comments(path.read_bytes()) - comments(formatted)
    if missing:
        problems.append(f"comments are lost: {list(missing)[:3]}")
    if gone := texts(path.read_bytes()) - texts(formatted):
        problems.append(f"texts are lost: {list(gone)[:3]}")
    lost = Counter(unknown_lines(path.read_bytes())) - Counter(unknown_lines(formatted))
    if lost:
        problems.append(f"lines of unknown sections are lost: {list(lost)[:3]}")
    return problems


def check_dcf(edsc: Path, path: Path, folder: Path) -> list[str]:
    dcf = folder / f"{path.stem}.dcf"
    made = run(edsc, "format", path, "--dcf", "--node-id", NODE_ID, "-o", dcf)
    if made.returncode != 0:
        return [f"--dcf ends with {made.returncode}"]
    same = configured(dump(edsc, dcf, *options_of(path))) == configured(dump(edsc, path, "--node-id", NODE_ID))
    return [] if same else ["the DCF is another device"]


def check_file(job: tuple[Path, Path, Path]) -> Outcome:
    edsc, path, scratch = job
    with tempfile.TemporaryDirectory(dir=scratch) as folder:
        try:
            result = run(edsc, "format", path)
            error = next((line for line in result.stderr.decode(errors="replace").splitlines() if ERROR.search(line)), "")
            if result.returncode == 1 and error and not result.stdout:
                return Outcome(path, refused=error.rpartition("/")[2])
            if result.returncode != 0 or error:
                return Outcome(path, problems=(f"exit code {result.returncode}, {error or 'without an error'}",))
            problems = check_canonical(edsc, path, result.stdout, Path(folder)) + check_dcf(edsc, path, Path(folder))
        except subprocess.TimeoutExpired:
            problems = [f"not done after {SECONDS} s"]
    return Outcome(path, problems=tuple(problems))


def own_data_sheets(source_dir: Path) -> list[Path]:
    folders = ("eds", "tests/fixtures", "examples")
    return sorted(path for folder in folders for path in (source_dir / folder).rglob("*.eds"))


def check_all(edsc: Path, paths: list[Path], scratch: Path) -> int:
    """Returns the number of files that fail a check."""
    outcomes = in_parallel(check_file, [(edsc, path, scratch) for path in paths])
    for outcome in outcomes:
        for problem in outcome.problems:
            print(f"{outcome.path}: {problem}")
        if outcome.refused:
            print(f"refused: {outcome.refused}")
    wrong = sum(bool(outcome.problems) for outcome in outcomes)
    refused = sum(bool(outcome.refused) for outcome in outcomes)
    print(f"{len(outcomes)} files: {len(outcomes) - wrong - refused} right, {refused} refused, {wrong} wrong")
    return wrong


def main() -> int:
    source_dir, edsc = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        wrong = check_all(edsc, own_data_sheets(source_dir), Path(scratch))
        corpus = find_corpus(source_dir)
        if corpus is None:
            print("SKIPPED: no corpus; set EDSC_CORPUS to its folder")
            return 1 if wrong else SKIPPED
        wrong += check_all(edsc, [corpus / path for path in paths_in(corpus)], Path(scratch))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
