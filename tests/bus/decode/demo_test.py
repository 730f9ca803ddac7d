#!/usr/bin/env python3
"""edsc decode names every frame of the demo network.

    demo_test.py SOURCE_DIR EDSC DEMO
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

NODES = {1: "ezd-1136", 2: "cpd", 3: "cpc-tc1", 4: "can-2053c", 5: "rk5c"}
SERVICES = {"nmt", "boot_up", "heartbeat", "tpdo", "rpdo", "sdo"}


def main() -> int:
    source, edsc, demo = (Path(argument).resolve() for argument in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "demo.log"
        subprocess.run([demo, "--log", log], check=True, stdout=subprocess.DEVNULL, timeout=600)
        nodes = [option for node, name in NODES.items() for option in ("--node", f"{node}={source}/eds/{name}.eds")]
        result = subprocess.run([edsc, "decode", *nodes, "--format", "json", log], capture_output=True, text=True, timeout=600,
                                check=False)
        frames = len(log.read_text().splitlines())
    messages = [json.loads(line) for line in result.stdout.splitlines()]
    problems = [result.stderr] if result.stderr or result.returncode != 0 else []
    if len(messages) != frames or frames < 50:
        problems.append(f"{frames} frames, {len(messages)} messages")
    services = {message["service"] for message in messages}
    if services != SERVICES:
        problems.append(f"services: {sorted(services)}")
    for message in messages:
        unnamed = message["service"] == "unknown" or "not in the log" in message["text"]
        unnamed |= message["service"] in ("tpdo", "rpdo") and not all(value.get("name") for value in message.get("values", [{}]))
        unnamed |= message["service"] == "sdo" and any(not value.get("name") for value in message.get("values", []))
        refused = message.get("transfer", {}).get("step") == "aborted"  # the demo writes a read-only object
        if unnamed or (message.get("problem") and not refused):
            problems.append(json.dumps(message))
    print("\n".join(problems))
    print(f"{len(messages)} frames, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
