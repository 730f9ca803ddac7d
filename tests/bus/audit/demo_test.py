#!/usr/bin/env python3
"""edsc audit: the demo network behaves as the EDS files of its nodes state.

    demo_test.py SOURCE_DIR EDSC DEMO
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

NODES = {1: "ezd-1136", 2: "cpd", 3: "cpc-tc1", 4: "can-2053c", 5: "rk5c"}
FRAMES = 50


def main() -> int:
    source, edsc, demo = (Path(argument).resolve() for argument in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "demo.log"
        subprocess.run([demo, "--log", log], check=True, stdout=subprocess.DEVNULL, timeout=600)
        nodes = [option for node, name in NODES.items() for option in ("--node", f"{node}={source}/eds/{name}.eds")]
        result = subprocess.run([edsc, "audit", *nodes, "--format", "json", log], capture_output=True, text=True, timeout=600,
                                check=False)
    report = json.loads(result.stdout)
    # The demo writes a read-only object to show the abort.
    unexpected = [one for one in report["findings"] if one["rule"] != "sdo-abort"]
    print(result.stderr + json.dumps(unexpected, indent=1))
    print(f"{report['frames']} frames of {report['nodes']} nodes, {len(unexpected)} unexpected findings")
    return 0 if result.returncode == 0 and not unexpected and report["frames"] > FRAMES and report["nodes"] == len(NODES) else 1


if __name__ == "__main__":
    sys.exit(main())
