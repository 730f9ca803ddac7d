#!/usr/bin/env python3
"""A DBC parser without edsc's code reads the files of `edsc generate --dbc` for the reference devices.

    dbc_read_back_test.py SOURCE_DIR EDSC WORK_DIR

Expected are the PDOs of the EDS files, which configparser reads, the signals of `edsc dump` (dbc_signals.py), and the names of
objects that are words of C++. The parser is candied, which npm installs in WORK_DIR.
Exit code 77: skipped.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "masters"), str(HERE.parents[1] / "support")]
import dbc_signals  # noqa: E402
from data_sheet import DataSheet  # noqa: E402
from dbc_signals import EXTENDED, INVALID, Signal, sheet_mapping  # noqa: E402
from npm_packages import Skipped, install_npm_packages  # noqa: E402

SKIPPED = 77
NODE_ID = 5

# Names of objects from 2000h on, and of their signals.
WORDS = {"Switch": "switch", "Float": "float", "Class": "class", "int": "int", "Speed": "speed", "SPEED": "speed_2005"}


def signal_view(signal: Signal) -> dict:
    return {"entry": signal.entry, "startBit": signal.start, "length": signal.bits, "signed": signal.signed,
            "endian": "Intel", "factor": float(signal.scale), "offset": float(signal.offset)}


def messages_of(sheet: DataSheet, dump: dict) -> dict[int, dict]:
    """The enabled PDOs of the EDS, by the number of the message. Their signals are those of the meaning."""
    messages = {}
    signals = {message.number: message.signals for message in dbc_signals.messages_of(dump)}
    for first, last, mapping in ((0x1400, 0x15FF, 0x200), (0x1800, 0x19FF, 0x200)):
        for index in range(first, last + 1):
            cob_id = sheet.default(index, 1, INVALID)
            if cob_id & INVALID:
                continue
            bits = sum(sheet.default(index + mapping, sub) & 0xFF for sub in range(1, sheet.default(index + mapping, 0, 0) + 1))
            number = cob_id & 0x1FFFFFFF | INVALID if cob_id & EXTENDED else cob_id & 0x7FF
            timer = sheet.default(index, 5, 0) if first == 0x1800 and sheet.default(index, 2) >= 254 else 0
            messages.setdefault(number, {"dlc": (bits + 7) // 8, "cycle": timer,
                                         "signals": [signal_view(signal) for signal in signals[number]]})
    return messages


def read_back(messages: list[dict]) -> dict[int, dict]:
    """The same, from the output of candied. Its description of a signal begins with the index."""
    found = {}
    for message in messages:
        signals = []
        for signal in message["signals"].values():
            keys = ("startBit", "length", "signed", "endian", "factor", "offset")
            signals.append({"entry": signal["description"].split()[0], **{key: signal[key] for key in keys}})
        number = message["id"]
        cycle = message["attributes"].get("GenMsgCycleTime", {"value": 0})["value"]
        found[number] = {"dlc": message["dlc"], "cycle": int(cycle), "signals": signals}
    return found


def main() -> int:
    source, edsc, work = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    try:
        install_npm_packages(HERE / "candied", work)
    except Skipped as reason:
        print(f"skipped: {reason}")
        return SKIPPED
    sheets = {path.stem: path for path in sorted((source / "eds").glob("*.eds"))}
    problems = count = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, path in sheets.items():
            subprocess.run([edsc, "generate", path, "--options", path.with_suffix(".options.json"), "--node-id", str(NODE_ID),
                            "--dbc", f"{folder}/{name}.dbc"], check=True, stderr=subprocess.DEVNULL)
        words = Path(folder, "words.eds")
        words.write_text(sheet_mapping([*WORDS]), encoding="utf-8")
        subprocess.run([edsc, "generate", words, "--node-id", str(NODE_ID), "--dbc", words.with_suffix(".dbc")], check=True,
                       stderr=subprocess.DEVNULL)
        files = [*(f"{folder}/{name}.dbc" for name in sheets), str(words.with_suffix(".dbc"))]
        output = subprocess.run(["node", work / "read_dbc.js", *files], check=True, capture_output=True, text=True).stdout
        message, = json.loads(output)[files[-1]]
        if list(message["signals"]) != list(WORDS.values()):
            problems += 1
            print(f"names of signals:\n  expected {list(WORDS.values())}\n  got      {list(message['signals'])}")
        for (name, path), file in zip(sheets.items(), files):
            expected, found = messages_of(DataSheet(path, NODE_ID), dbc_signals.dump_of(edsc, path, NODE_ID)), read_back(json.loads(output)[file])
            count += len(expected)
            for number in sorted(expected.keys() | found.keys()):
                if expected.get(number) != found.get(number):
                    problems += 1
                    print(f"{name}: message {number:X}h:\n  expected {expected.get(number)}\n  got      {found.get(number)}")
    assert count > 8, "the EDS files have no PDOs"
    print(f"{len(sheets)} files, {count} messages, {problems} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
