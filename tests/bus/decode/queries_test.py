#!/usr/bin/env python3
"""The commands of examples/logs/README.md, with a log of 100,000 frames, whose contents make_log.py determines.

    queries_test.py SOURCE_DIR EDSC WORK_DIR

Skipped if npm cannot install DuckDB.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))

from npm_packages import Skipped, install_npm_packages  # noqa: E402

# 100,000 frames at 100 ticks a second: 101 frames a second, and one more each minute. With T ticks these are T + T/100 + T/6000
# + T/360,000 frames; T = 98,993: 98,993 heating powers, 990 heartbeats, 17 setpoints (ticks 2, 6002, ..., 96,002) and the EMCY
# of tick 3000 are 100,001, so that the last power is not among them.
FRAMES = 100_000
POWERS, HEARTBEATS, SETPOINTS = 98_992, 990, 17
ALL_SETPOINTS = [20 + minute * 13 % 60 for minute in range(SETPOINTS)]  # in °C


def run(command: list[str], work: Path, environment: dict[str, str]) -> str:
    return subprocess.run(command, cwd=work, env=environment, shell=True, check=True, text=True, timeout=900,  # noqa: S602
                          stdout=subprocess.PIPE).stdout


def main() -> int:
    source, edsc, base = (Path(argument).resolve() for argument in sys.argv[1:4])
    work = base / "logs"
    (base / "heater").mkdir(parents=True, exist_ok=True)
    for name in ("heater.eds", "heater.options.json"):
        shutil.copy(source / "examples/heater" / name, base / "heater")
    try:
        install_npm_packages(source / "examples/logs", work)
    except Skipped as reason:
        print(f"skipped: {reason}")
        return 77
    environment = {**os.environ, "PATH": f"{edsc.parent}{os.pathsep}{os.environ['PATH']}"}
    output: dict[str, list[dict]] = {}
    for command in re.search(r"```sh\n(.*?)```", (work / "README.md").read_text(), re.DOTALL)[1].splitlines():
        if command.startswith("npm "):
            continue
        text = run(command.replace("1000000", str(FRAMES)), work, environment)
        output[command] = [json.loads(line) for line in text.splitlines()]
    setpoint, power, response = output["node query.mjs values.sql"]
    emergency, *rates = output["node query.mjs problems.sql"]
    wanted = [
        (setpoint["name"], "Setpoint"), (setpoint["object"], "2000h:00"), (setpoint["unit"], "°C"), (int(setpoint["values"]), SETPOINTS),
        (setpoint["min"], min(ALL_SETPOINTS)), (setpoint["max"], max(ALL_SETPOINTS)),
        (setpoint["mean"], round(sum(ALL_SETPOINTS) / SETPOINTS, 3)),
        (power["name"], "Heating power"), (int(power["values"]), POWERS),
        (int(response["setpoints"]), SETPOINTS), (response["longest_ms"], 10.0),
        (emergency["error"], "4210h"),
        ({row["service"]: int(row["frames"]) for row in rates}, {"tpdo": POWERS, "heartbeat": HEARTBEATS, "rpdo": SETPOINTS}),
        ("<svg" in (work / "heater.svg").read_text(), True)]
    problems = [f"{found!r} instead of {right!r}" for found, right in wanted if found != right]
    print("\n".join(problems) or f"{len(wanted)} results of DuckDB are right")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
