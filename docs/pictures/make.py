#!/usr/bin/env python3
"""Draws the pictures of the documents with edsc.

    make.py EDSC OUTPUT

`tests/docs/pictures_test.py` compares them with those of docs/pictures.
"""

from __future__ import annotations

import html
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE_DIR = Path(__file__).resolve().parents[2]
EDS = SOURCE_DIR / "eds"
LINE_HEIGHT, CHARACTER = 17, 7.6


def run(edsc: Path, *arguments: object, folder: Path, may_fail: bool = False) -> str:
    result = subprocess.run([edsc, *map(str, arguments)], cwd=folder, capture_output=True, text=True,
                            env={**os.environ, "TZ": "UTC", "NO_COLOR": "1"})
    if result.returncode != 0 and not may_fail:
        raise SystemExit(f"edsc {' '.join(map(str, arguments))}: {result.stdout}{result.stderr}")
    return result.stdout


def terminal(title: str, command: str, output: str) -> str:
    """A drawing of a terminal."""
    lines = [f"$ {command}", *output.rstrip("\n").split("\n")]
    width, height = round(max(map(len, lines)) * CHARACTER) + 24, len(lines) * LINE_HEIGHT + 20
    rows = "".join(f'<text x="12" y="{24 + i * LINE_HEIGHT}" xml:space="preserve">{html.escape(line)}</text>\n'
                   for i, line in enumerate(lines))
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" role="img">\n'
            f"<title>{html.escape(title)}</title>\n"
            "<style>rect { fill: #1b1f24 } text { fill: #e3e7ec; font: 12.6px ui-monospace, Menlo, Consolas, monospace }</style>\n"
            f'<rect width="{width}" height="{height}" rx="6"/>\n{rows}</svg>\n')


def plant(edsc: Path, folder: Path) -> str:
    """The drawing that `edsc network generate` writes."""
    run(edsc, "network", "generate", SOURCE_DIR / "examples/networks/four_modules.json", "-o", "plant", folder=folder)
    return (folder / "plant/four_modules.svg").read_text(encoding="utf-8")


def pdo(edsc: Path, folder: Path) -> str:
    """The first drawing of a device page, with the style of a drawing that is a file."""
    style = re.search(r"<style>.*?</style>", plant(edsc, folder), re.DOTALL)
    page = run(edsc, "document", EDS / "rk5c.eds", folder=folder)
    drawing = re.search(r'<svg (viewBox="0 0 (\d+) (\d+)".*?)>(.*?</svg>)', page, re.DOTALL)
    assert style is not None and drawing is not None
    return (f'<svg xmlns="http://www.w3.org/2000/svg" {drawing[1]}>\n{style[0]}\n'
            f'<rect class="page" width="{drawing[2]}" height="{drawing[3]}"/>{drawing[4]}\n')


def plot(edsc: Path, folder: Path) -> str:
    log = subprocess.run([sys.executable, SOURCE_DIR / "examples/logs/make_log.py", "20000"], capture_output=True, text=True, check=True)
    (folder / "heater.log").write_text(log.stdout, encoding="utf-8")
    run(edsc, "plot", "heater.log", "setpoint", "heating_power", "--node", f"5={SOURCE_DIR}/examples/heater/heater.eds", "-o",
        "heater.svg", folder=folder)
    return (folder / "heater.svg").read_text(encoding="utf-8")


def check(edsc: Path, folder: Path) -> str:
    """TPDO 1 of the pump maps the setpoint, which only an RPDO may map."""
    text = (SOURCE_DIR / "examples/first_device/pump.eds").read_text(encoding="utf-8")
    right = "DefaultValue=0x20010010"
    assert right in text
    (folder / "pump.eds").write_text(text.replace(right, "DefaultValue=0x20000010"), encoding="utf-8")
    output = run(edsc, "check", "pump.eds", "--silence", "pdo-both-directions", folder=folder, may_fail=True)
    return terminal("edsc check reports a wrong mapping", "edsc check pump.eds", output)


def decode(edsc: Path, folder: Path) -> str:
    (folder / "pump.log").write_text("(0.0) can0 705#05\n(0.1) can0 205#9006\n(0.1) can0 185#A401\n(0.2) can0 605#4000200000000000\n"
                                     "(0.2) can0 585#4B00200090060000\n", encoding="utf-8")
    output = run(edsc, "decode", "pump.log", "--node", f"5={SOURCE_DIR}/examples/first_device/pump.eds", folder=folder)
    return terminal("edsc decode shows the values of frames", "edsc decode pump.log --node 5=pump.eds", output)


PICTURES = {"check.svg": check, "decode.svg": decode, "pdo.svg": pdo, "plant.svg": plant, "plot.svg": plot}


def main() -> int:
    edsc, output = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    for name, draw in PICTURES.items():
        with tempfile.TemporaryDirectory() as folder:
            (output / name).write_text(draw(edsc, Path(folder)), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
