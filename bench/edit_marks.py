#!/usr/bin/env python3
"""Times of the page of `edsc edit` in Chromium for an EDS of 500 kB and for 10,000 entries: 95th percentiles.

    edit_marks.py SOURCE_DIR EDSC [--samples N] [--work FOLDER] [--check]

npm installs puppeteer-core in FOLDER, a temporary one by default. --check fails above the marks. The time of a frame is that of
the page's thread: script, styles, layout and painting.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from lsp_marks import big_sheet, percentile

MARKS = {"open, ms": ("open", 700), "key to findings, ms": ("key", 100), "frame of a scroll, ms": ("scroll", 16)}


def section(title: str, **keys: object) -> str:
    return f"\n[{title}]\n" + "".join(f"{key}={value}\n" for key, value in keys.items())


def many_entries(source: Path, count: int) -> str:
    """An EDS with ARRAYs of 250 elements from 3000h on."""
    text = source.read_text(encoding="utf-8")
    indices = [0x3000 + at for at in range(-(-count // 250))]
    head, tail = text.split("[ManufacturerObjects]\n", 1)
    listed, *sections = tail.split("\n\n", 1)
    _, *before = listed.split("\n")
    lines = "\n".join([*before, *(f"{at + 1}=0x{index:04X}" for at, index in enumerate(indices, start=len(before)))])
    objects: list[str] = []
    for index in indices:
        objects.append(section(f"{index:04X}", ParameterName=f"Table {index:04X}", ObjectType="0x8", SubNumber=251))
        objects.append(section(f"{index:04X}sub0", ParameterName="Highest sub-index supported", ObjectType="0x7", DataType="0x0005",
                               AccessType="const", DefaultValue=250, PDOMapping=0))
        objects += [section(f"{index:04X}sub{sub:X}", ParameterName=f"Value {sub}", ObjectType="0x7", DataType="0x0006", AccessType="rw",
                            DefaultValue=0, PDOMapping=0) for sub in range(1, 251)]
    return f"{head}[ManufacturerObjects]\nSupportedObjects={len(before) + len(indices)}\n{lines}\n\n" + "\n\n".join(sections) + "".join(objects)


def measured(edsc: Path, work: Path, text: str, samples: int) -> dict:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "big.eds").write_text(text, encoding="utf-8")
        server = subprocess.Popen([edsc, "edit", "big.eds", "--no-browser"], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                  env=os.environ | {"XDG_STATE_HOME": folder}, text=True)
        try:
            url = server.stdout.readline().strip()
            browser = subprocess.run(["node", "edit_marks.mjs", shutil.which("chromium"), url, str(samples)], cwd=work, capture_output=True,
                                     text=True, check=False)
        finally:
            server.kill()
            server.wait()
    if browser.returncode != 0:
        sys.exit(browser.stderr)
    return json.loads(browser.stdout)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=Path)
    parser.add_argument("edsc", type=Path)
    parser.add_argument("--samples", type=int, default=100)
    parser.add_argument("--work", type=Path)
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    sys.path.append(str(arguments.source / "tests/support"))
    from npm_packages import install_npm_packages

    with tempfile.TemporaryDirectory() as folder:
        work = (arguments.work or Path(folder)).resolve()
        install_npm_packages(arguments.source / "tests/document/browser", work)
        sheet = arguments.source / "eds/rk5c.eds"
        sheets = (("500 kB", big_sheet(sheet), ("open", "key", "scroll")), ("10,000 entries", many_entries(sheet, 10_000), ("scroll",)))
        is_met = True
        for name, text, keys in sheets:
            found = measured(arguments.edsc.resolve(), work, text, arguments.samples)
            print(f"{name}, {found['entries']} rows")
            for mark, (key, most) in MARKS.items():
                if key in keys:
                    value = percentile(found[key])
                    is_met = is_met and value <= most
                    print(f"  {mark:<24} {value:8.1f}   mark {most}")
    return int(arguments.check and not is_met)


if __name__ == "__main__":
    sys.exit(main())
