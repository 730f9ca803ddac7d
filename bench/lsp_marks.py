#!/usr/bin/env python3
"""Times of `edsc lsp` for an EDS of 500 kB: 95th percentiles from a message to the answer, and the memory after many edits.

    lsp_marks.py SOURCE_DIR EDSC [--edits N] [--check]

--check fails above the marks. The client reads in a thread, whose time is part of the result.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

MARKS = {"key to diagnostics, ms": 40, "completion, ms": 20, "hover, ms": 20, "memory, MB": 100}
SIZE = 500_000
SAMPLES = 200


def big_sheet(source: Path) -> str:
    """An EDS with further objects from 2800h on."""
    text = source.read_text(encoding="utf-8")
    head, tail = text.split("[ManufacturerObjects]\n", 1)
    objects: list[str] = []
    index = 0x2800
    while len(text) + sum(map(len, objects)) < SIZE:
        objects.append(f"\n[{index:04X}]\nParameterName=Value {index:04X}\nObjectType=0x7\nDataType=0x0006\nAccessType=rw\n"
                       f"DefaultValue=0x0000\nPDOMapping=0\nLowLimit=0x0000\nHighLimit=0xFFFF\n")
        index += 1
    count, rest = tail.split("\n", 1)
    listed, *sections = rest.split("\n\n", 1)
    before = int(count.split("=")[1], 0)
    lines = "".join(f"\n{before + 1 + i}=0x{0x2800 + i:04X}" for i in range(len(objects)))
    return (f"{head}[ManufacturerObjects]\nSupportedObjects={before + len(objects)}\n{listed}{lines}\n\n" + "\n\n".join(sections) +
            "".join(objects))


def percentile(times: list[float]) -> float:
    return sorted(times)[int(len(times) * 0.95)]


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--edits", type=int, default=10_000)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    sys.path.insert(0, str(arguments.source / "tests/generator/lsp"))
    from lsp_client import Client

    client = Client(arguments.edsc.resolve())
    results: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "big.eds"
        path.write_text(big_sheet(arguments.source / "eds/rk5c.eds"), encoding="utf-8")
        uri = client.open(path)
        client.published(uri)
        lines = path.read_text(encoding="utf-8").split("\n")
        line = max(i for i, text in enumerate(lines) if text.startswith("ParameterName="))
        at = {"line": line, "character": len(lines[line])}
        times: dict[str, list[float]] = {name: [] for name in MARKS if "ms" in name}

        def timed(name: str, run: object) -> None:
            start = time.perf_counter()
            run()
            times[name].append((time.perf_counter() - start) * 1000)

        def type_key(number: int) -> None:
            end = {"line": line, "character": at["character"] + number % 2}
            client.change(uri, [{"range": {"start": at, "end": end}, "text": "x" if number % 2 == 0 else ""}])

        def key(number: int) -> None:
            type_key(number)
            client.published(uri)

        for number in range(SAMPLES):
            client.messages.clear()
            timed("key to diagnostics, ms", lambda number=number: key(number))
            timed("completion, ms", lambda: client.at("completion", uri, line + 2, 4))
            timed("hover, ms", lambda: client.at("hover", uri, line, 4))
        for name, values in times.items():
            results[name] = percentile(values)
        for number in range(arguments.edits):
            client.messages.clear()
            type_key(number)
            if number % 50 == 49:
                client.published(uri)
        status = Path(f"/proc/{client.process.pid}/status").read_text(encoding="ascii")
        results["memory, MB"] = int(status.split("VmRSS:")[1].split()[0]) / 1024
    client.end()
    for name, value in results.items():
        print(f"{name:<24} {value:8.1f}   mark {MARKS[name]}")
    return int(arguments.check and any(value > MARKS[name] for name, value in results.items()))


if __name__ == "__main__":
    sys.exit(main())
