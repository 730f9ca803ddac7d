#!/usr/bin/env python3
"""Writes a candump log of the heater of examples/heater, node 5: `make_log.py FRAMES > heater.log`.

Each 10 ms the heating power, TPDO 1; each second a heartbeat; each minute a new setpoint, RPDO 1, of 20.0 to 80.0 degrees,
and each hour an EMCY.
"""

import sys


def frames():
    for tick in range(2**40):
        minute = tick // 6000
        setpoint = 200 + minute * 130 % 600
        since_change = tick % 6000 / 6000
        yield tick, f"185#{int(setpoint / 10 * (1 - since_change / 2)):02X}"
        if tick % 100 == 1:
            yield tick, "705#05"
        if tick % 6000 == 2:
            yield tick, "205#" + setpoint.to_bytes(2, "little").hex().upper()
        if tick % 360_000 == 3000:
            yield tick, "085#1042090000000000"


def main() -> None:
    left = int(sys.argv[1])
    for tick, frame in frames():
        if left == 0:
            break
        left -= 1
        print(f"({1_700_000_000 + tick // 100}.{tick % 100 * 10_000:06}) can0 {frame}")


if __name__ == "__main__":
    main()
