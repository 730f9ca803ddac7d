#!/usr/bin/env python3
"""The commands of docs/can0.md, with a node on the other controller of the bus.

    can0_page_test.py PAGE EDSC VM_NODE     in a machine with can0 and can1
"""

from __future__ import annotations

import os
import re
import sys
import time
from pathlib import Path

from can_bus import Program, expect, run

BLOCK = re.compile(r"<!-- run by: tests/vm/can0_page_test.py -->\n```sh\n(.*?)```", re.DOTALL)


def main() -> int:
    page, edsc, vm_node = sys.argv[1:]
    os.environ["PATH"] += os.pathsep + str(Path(edsc).parent)
    commands = [line for block in BLOCK.findall(Path(page).read_text(encoding="utf-8")) for line in block.splitlines()]
    run("ip link set can0 down")  # as after plugging in
    run("ip link set can1 down")
    run("ip link set can1 up type can bitrate 500000")
    printed: dict[str, str] = {}
    with Program(vm_node, "socketcan:can1", "7"):
        time.sleep(0.5)
        for command in commands:
            printed[command] = run(command)
    expect("state", "ERROR-ACTIVE" in printed["ip -details -statistics link show can0"], True)
    expect("the node is found", "7" in printed["edsc scan socketcan:can0 --nodes 1..10"].split(), True)
    expect("vendor-ID", "1018h:01" in printed["edsc read socketcan:can0 7 1018h:01 --type u32"], True)
    expect("the virtual bus is up", "UP" in run("ip link show plant0"), True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
