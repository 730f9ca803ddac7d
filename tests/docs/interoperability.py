#!/usr/bin/env python3
"""Programs of others that tests use together with edsc: docs/interoperability.md is printed from the rows and the tests.

    interoperability.py SOURCE_DIR BUILD_DIR [--write]

With --write, runs the tests of the rows in BUILD_DIR and writes the page with their results. Without, compares the versions of the
page with those of the lock files and of the packages that are installed, and its tests with those of BUILD_DIR. Exit code 77: none
of the packages is installed.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.debian import is_debian  # noqa: E402

SOURCE_DIR, BUILD_DIR = (Path(argument).resolve() for argument in sys.argv[1:3])
PAGE = SOURCE_DIR / "docs/interoperability.md"
DEBIAN = 12  # whose versions the page has


@dataclass(frozen=True)
class Row:
    program: str
    source: str  # a package of Debian, or a lock file and its package
    tried: str
    test: str
    figures: tuple[tuple[str, str], ...]  # a pattern of the test's output, whose numbers are added, and the words after the sum


ROWS = (
    Row("python-can", "python3-can", "a master on it reads, writes and supervises the eight reference devices", "masters_python_can",
        ((r": (\d+) checks ok", "checks passed"), (r"checks ok, (\d+) failed", "failed"),
         (r"failed, (\d+) by exception", "with an exception in `tests/masters/exceptions.tsv`"))),
    Row("canopen of npm", "tests/masters/node_canopen/package-lock.json canopen", "its master with the eight reference devices",
        "masters_node_canopen", ((r": (\d+) checks ok", "checks passed"), (r"checks ok, (\d+) failed", "failed"))),
    Row("canopen of npm", "tests/masters/node_canopen/package-lock.json canopen", "its master with the eight devices as nodes of `edsc node`",
        "masters_node_canopen_simulated", ((r": (\d+) checks ok", "checks passed"), (r"checks ok, (\d+) failed", "failed"))),
    Row("canopen of npm", "tests/masters/node_canopen/package-lock.json canopen",
        "edsc's master boots its slave, and nine slaves in Python with behaviours of real plants", "foreign_slaves",
        ((r"(?m)^(?:\d+: )?ok (?= )()", "behaviours as expected"),)),
    Row("canopen of npm", "tests/masters/node_canopen/package-lock.json canopen",
        "`edsc conform` reports the gaps of its slave, and nothing else", "conform_foreign", ()),
    Row("canmatrix", "python3-canmatrix", "it decodes frames by the DBC files of `edsc generate`; each value is compared", "dbc_decode",
        ((r"(\d+) signals,", "signals compared"), (r"signals, (\d+) problems", "different"))),
    Row("canmatrix", "python3-canmatrix", "`edsc network generate` takes names of signals from its DBC files, and it reads them back",
        "signal_names", ()),
    Row("python-can", "python3-can", "`edsc decode` reads its logs: ASC, BLF, TRC 1.0 and 2.1", "decode_formats", ()),
    Row("can-utils", "can-utils", "`edsc decode` reads logs of candump, and ASC files of log2asc", "decode_formats", ()),
    Row("scapy", "python3-scapy", "`edsc decode` reads its captures: pcap and pcapng", "decode_formats", ()),
    Row("python-can", "python3-can", "its interface socketcand exchanges frames on `edsc bus`", "bus", ()),
    Row("DuckDB of npm", "examples/logs/package-lock.json @duckdb/node-api", "queries over CSV and JSON of `edsc decode`",
        "decode_queries", ()),
)
HEAD = """# Interoperability

Programs of others that the tests of edsc use together with it. `tests/docs/interoperability.py --write` prints this page from the
runs of these tests. No stack for devices in C or C++, such as CANopenNode, and no device with CAN hardware is among them.
[What has run where](porting.md#what-has-run-where) has the kernels and processors.

| program | version | what was tried | test | result |
|---|---|---|---|---|
"""

TAIL = """
## Tried by hand

These programs are not packages of Debian or npm, and CI does not run them:

- Lely's CANopen library, commit 620d1858 of lely-core, with the files of `edsc network generate --target lely` for
  `examples/networks/four_modules.json`. `dcfgen -r -S bus.yml` wrote the concise DCFs of edsc, byte for byte. A program with Lely's
  AsyncMaster on `edsc bus` booted 4 of 4 nodes of `edsc node`, with the `controller.dcf` of edsc and with the `master.dcf` of dcfgen;
  with the latter it received the values of their TPDOs. Its time-out for SDO was 3 s, as the computer was busy. Without `--target lely`
  it booted none.
- ros2_canopen was not run: its documents state the members `driver` and `package` of `bus.yml`.
"""


def version_of(source: str) -> str:
    """Empty if the package of Debian is not installed."""
    if " " in source:
        file, package = source.split()
        return json.loads((SOURCE_DIR / file).read_text(encoding="utf-8"))["packages"][f"node_modules/{package}"]["version"]
    shown = subprocess.run(["dpkg-query", "-W", "-f=${Version}", source], capture_output=True, text=True, check=False)
    return shown.stdout.strip()


def result_of(row: Row) -> str:
    """Runs the test."""
    ran = subprocess.run(["ctest", "--test-dir", BUILD_DIR, "-V", "-R", f"^{row.test}$"], capture_output=True, text=True, check=False)
    if "Test #" not in ran.stdout or "100% tests passed, 0 tests failed out of 1" not in ran.stdout or "***Skipped" in ran.stdout:
        raise SystemExit(f"{row.test} has not passed:\n{ran.stdout[-3000:]}")
    parts = []
    for pattern, words in row.figures:
        found = re.findall(pattern, ran.stdout)
        parts.append(f"{sum(int(number or 1) for number in found)} {words}")
    return "passed" + (": " + ", ".join(parts) if parts else "")


def cells_of_page() -> list[list[str]]:
    rows = [line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in rows[1:]]


def write() -> int:
    results: dict[Row, str] = {}
    for row in ROWS:
        same = next((one for one in results if (one.test, one.figures) == (row.test, row.figures)), None)
        results[row] = results[same] if same else result_of(row)
        print(f"{row.program}: {row.test}: {results[row]}", flush=True)
    lines = [f"| {row.program} | {version_of(row.source)} | {row.tried} | `{row.test}` | {result} |" for row, result in results.items()]
    PAGE.write_text(HEAD + "\n".join(lines) + "\n" + TAIL, encoding="utf-8")
    return 0


def compare() -> int:
    if not any(version_of(row.source) for row in ROWS if " " not in row.source):
        print("SKIPPED: none of the packages is installed")
        return 77
    problems = []
    tests = subprocess.run(["ctest", "--test-dir", BUILD_DIR, "-N"], capture_output=True, text=True, check=True).stdout
    cells = cells_of_page()
    if [(one[0], one[2], one[3]) for one in cells] != [(row.program, row.tried, f"`{row.test}`") for row in ROWS]:
        problems.append("docs/interoperability.md has other rows: interoperability.py --write")
    is_of_the_page = is_debian(DEBIAN)
    if not is_of_the_page:
        print(f"versions are not compared: those of the page are of Debian {DEBIAN}")
    for row, one in zip(ROWS, cells):
        if is_of_the_page and (version := version_of(row.source)) and version != one[1]:
            problems.append(f"docs/interoperability.md: {row.program}: {one[1]}; the version is {version}")
        if not re.search(rf": {row.test}$", tests, re.MULTILINE):
            problems.append(f"docs/interoperability.md: there is no test {row.test}")
    print("\n".join(problems))
    print(f"{len(cells)} rows, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(write() if "--write" in sys.argv else compare())
