#!/usr/bin/env python3
"""Measures edsc on an EDS and a compiler on the generated code, with the figures of other tools.

    compile_time.py EDSC RUNTIME_INCLUDE_DIR

Prints for each EDS of sheets.py the user time and the peak memory of edsc, and of g++ and clang++ for the device header
alone, for a file with a node, and for another file of the same program, which sets an object of the node and gets one, at -O2. Best of
three runs. The header needs only the compilers' default limits for constant expressions; for a node, Clang gets the limit of
edsc_add_dictionary.
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
TYPE = HEADER + """#include <canopen/node.hpp>
struct Bus {
  bool send(const canopen::Frame&) { return true; }
};
using Node = canopen::Node<canopen::Composition<device::Device>, Bus>;
"""
NODE = TYPE + """Bus bus;
Node node{bus};
int main() {
  node.start(canopen::NodeId{5}, {});
  node.on_time({});
  node.on_frame(canopen::make_frame(0x605, 8, {0x0060'8323, 77}), {});
}
"""
OTHER = TYPE + """extern Node node;
bool set(std::uint16_t time) { return node.set(device::od::hb_producer_time{}, canopen::raw(time)) == canopen::ok; }
std::uint32_t get() { return to_raw(node.get(device::od::cycle_period{})); }
"""
SOURCES = {"header": HEADER, "node": NODE, "other file": OTHER}
SHEETS = {"node": {"ref", "eds1000", "pdos512"},  # the other sheets have DOMAINs, for which a node needs memory
          "other file": {"ref"}}
LIMITS = {"clang++": ["-fconstexpr-steps=100000000"]}


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
    print(f"{'':12}{'edsc':>17}" + "".join(f"{compiler + ' ' + what:>19}" for what in SOURCES for compiler in COMPILERS))
    with tempfile.TemporaryDirectory() as folder:
        for sheet in sheets.SHEETS:
            path = sheets.write(sheet, Path(folder))
            row = best([edsc, "generate", str(path), "-o", folder, "--name", "device"])
            for what, text in SOURCES.items():
                if what in SHEETS and sheet not in SHEETS[what]:
                    continue
                source = Path(folder) / "source.cpp"
                source.write_text(text, encoding="utf-8")
                limits = {} if what == "header" else LIMITS
                for compiler in COMPILERS:
                    row += "  " + best([compiler, "-std=c++20", "-O2", "-c", *limits.get(compiler, []), f"-I{folder}",
                                        f"-I{runtime}", str(source), "-o", os.devnull])
            print(f"{sheet:12} {row}", flush=True)
    print("\nOthers, on such a machine: generating eds1000 / eds5000: lely dcf2c 0.02 / 0.11 s, objdictgen 0.43 / 2.9 s,")
    print("modm-canopen 0.12 / 0.54 s; compiling a modm-canopen device of 1125 entries: 6.4 s, 845 MB.")


if __name__ == "__main__":
    main()
