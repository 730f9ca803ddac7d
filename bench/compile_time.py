#!/usr/bin/env python3
"""Measures edsc on an EDS and a compiler on the generated code, with the figures of other tools.

    compile_time.py EDSC RUNTIME_INCLUDE_DIR

Prints for each EDS of sheets.py the user time and the peak memory of edsc, and of g++ and clang++ for the device header
alone and, for the sheets of NODES, for a node, at -O2. Best of three runs. The header needs only the compilers' default limits for constant
expressions; for the node, Clang gets the limit of edsc_add_dictionary.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import sheets

COMPILERS = ["g++", "clang++"]
RUNS = 3
HEADER = "#include <device/device.hpp>\n"
NODE = HEADER + """#include <canopen/node.hpp>
struct Bus {
  bool send(const canopen::Frame&) { return true; }
} bus;
canopen::Node<canopen::Composition<device::Device>, Bus> node{bus};
int main() {
  node.start(canopen::NodeId{5}, {});
  node.on_time({});
  node.on_frame(canopen::make_frame(0x605, 8, {0x0060'8323, 77}), {});
}
"""
NODES = {"ref", "eds1000", "pdos512"}  # the other sheets have DOMAINs, for which a node needs memory
LIMITS = {"header": {}, "node": {"clang++": ["-fconstexpr-steps=100000000"]}}


def measure(command: list[str]) -> tuple[float, float]:
    """Seconds of user time and MB of one run."""
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {child.returncode}")
    return usage.ru_utime, usage.ru_maxrss / 1024


def best(command: list[str]) -> str:
    seconds, memory = min(measure(command) for _ in range(RUNS))
    return f"{seconds:6.2f} s {memory:5.0f} MB"


def main() -> None:
    edsc, runtime = sys.argv[1], sys.argv[2]
    print(f"{'':12}{'edsc':>17}" + "".join(f"{compiler + ' ' + what:>19}" for what in LIMITS for compiler in COMPILERS))
    with tempfile.TemporaryDirectory() as folder:
        for sheet in sheets.SHEETS:
            path = sheets.write(sheet, Path(folder))
            row = best([edsc, "generate", str(path), "-o", folder, "--name", "device"])
            for what, text in ("header", HEADER), ("node", NODE):
                if what == "node" and sheet not in NODES:
                    continue
                source = Path(folder) / f"{what}.cpp"
                source.write_text(text, encoding="utf-8")
                for compiler in COMPILERS:
                    row += "  " + best([compiler, "-std=c++20", "-O2", "-c", *LIMITS[what].get(compiler, []), f"-I{folder}",
                                        f"-I{runtime}", str(source), "-o", os.devnull])
            print(f"{sheet:12} {row}", flush=True)
    print("\nOthers, on such a machine: generating eds1000 / eds5000: lely dcf2c 0.02 / 0.11 s, objdictgen 0.43 / 2.9 s,")
    print("modm-canopen 0.12 / 0.54 s; compiling a modm-canopen device of 1125 entries: 6.4 s, 845 MB.")


if __name__ == "__main__":
    main()
