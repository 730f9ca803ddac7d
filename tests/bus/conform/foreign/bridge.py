#!/usr/bin/env python3
"""A bridge between two buses of `edsc bus` that does not forward remote frames, like many gateways.

    bridge.py ADDRESS OTHER_ADDRESS
"""

from __future__ import annotations

import select
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from foreign.frames import Bus  # noqa: E402


def main() -> None:
    first, second = (Bus(address) for address in sys.argv[1:])
    print("started", flush=True)
    while True:
        ready, _, _ = select.select([first.socket, second.socket], [], [])
        for source, target in ((first, second), (second, first)):
            if source.socket in ready:
                for frame in source.receive(0.0):
                    if not frame.remote:
                        target.send(frame)


if __name__ == "__main__":
    main()
