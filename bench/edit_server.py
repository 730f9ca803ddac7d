#!/usr/bin/env python3
"""The server of `edsc edit`: 95th percentile of the time from a change to its answer for an EDS of 500 kB, and the memory after
10,000 edits.

    edit_server.py SOURCE_DIR EDSC [--edits N] [--check]

--check fails above the marks. The time of a change includes the journal, which is written to the disk.
"""

from __future__ import annotations

import argparse
import http.client
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from lsp_marks import big_sheet, percentile

MARKS = {"change, ms": 100, "undo, ms": 100, "memory, MB": 100}
WARM_UP = 20


class Client:
    def __init__(self, url: str) -> None:
        parts = urlsplit(url)
        self.host, self.session = parts.netloc, ""
        self.session = self.post("session", {"token": parse_qs(parts.query)["token"][0]})["session"]

    def request(self, method: str, path: str, body: str | None = None) -> dict:
        connection = http.client.HTTPConnection(self.host, timeout=60)
        connection.request(method, path, body, {"Origin": f"http://{self.host}", "Content-Type": "application/json",
                                                "X-Edsc-Session": self.session})
        answer = connection.getresponse()
        content = json.loads(answer.read())
        connection.close()
        if answer.status != 200 or "rejected" in content:
            sys.exit(f"{path}: {answer.status} {content}")
        return content

    def post(self, action: str, request: object) -> dict:
        return self.request("POST", f"/{action}", json.dumps(request))


def memory_mb(process: int) -> float:
    for line in Path(f"/proc/{process}/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmHWM"):
            return int(line.split()[1]) / 1024
    raise AssertionError("no VmHWM")


def measure(client: Client, process: int, edits: int) -> dict[str, float]:
    state = client.request("GET", "/state?since=0")
    sections = [entry["section"] for name, part in state["parts"].items() if name.startswith("object/2")
                for entry in part["entries"] if entry["type"] in ("UNSIGNED16", "INTEGER16", "UNSIGNED32", "INTEGER32")]
    version, times = state["version"], {"change, ms": [], "undo, ms": []}

    def timed(name: str, action: str, request: dict) -> None:
        nonlocal version
        start = time.perf_counter()
        version = client.post(action, {"since": version, **request})["version"]
        times[name].append(1000 * (time.perf_counter() - start))

    for number in range(edits):
        change = {"do": "set", "section": sections[number % len(sections)], "key": "DefaultValue", "value": str(number % 100 + 1)}
        timed("change, ms", "change", {"changes": [change], "force": True})
        if number % 10 == 9:
            timed("undo, ms", "undo", {})
    return {**{name: percentile(values[WARM_UP:] or values) for name, values in times.items()}, "memory, MB": memory_mb(process)}


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("source_dir", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--edits", type=int, default=10_000)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = big_sheet(options.source_dir / "eds/rk5c.eds")
        (Path(folder) / "big.eds").write_text(text, encoding="utf-8")
        print(f"{len(text) // 1000} kB, {options.edits} edits")
        server = subprocess.Popen([options.edsc.resolve(), "edit", "big.eds", "--no-browser"], cwd=folder, stdin=subprocess.PIPE,
                                  stdout=subprocess.PIPE, env=os.environ | {"XDG_STATE_HOME": folder}, text=True)
        try:
            results = measure(Client(server.stdout.readline().strip()), server.pid, options.edits)
        finally:
            server.kill()
            server.wait()
    for name, value in results.items():
        print(f"{name:12} {value:8.1f}  mark {MARKS[name]}")
    if options.check and any(value > MARKS[name] for name, value in results.items()):
        sys.exit("above the marks")


if __name__ == "__main__":
    main()
