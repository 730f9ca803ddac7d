#!/usr/bin/env python3
"""A program that includes a header of plants or simulation by its old path compiles, and uses what the header declares.

    old_paths_test.py SOURCE_DIR

The old paths are those of "Include paths" in CHANGELOG.md in `canopen/plant/` and `canopen/host/`, to which older programs refer.
"""

from __future__ import annotations

import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.compilers import GCC, compile_only, in_parallel  # noqa: E402

ROW = re.compile(r"^\| (`canopen/.*`) \| `canopen_(?:plant|sim)/.+` \|$", re.MULTILINE)
OLD_PATH = re.compile(r"`(canopen/(?:plant|host)/[^`]+)`")
# What a program uses of each header.
USES = {
    "canopen/host/bus_faults.hpp": "canopen::BusFaults* faults;",
    "canopen/host/network_simulation/heartbeat_watch.hpp": "canopen::network_simulation::HeartbeatListener* listener;",
    "canopen/host/network_simulation/network_simulation.hpp": "canopen::network_simulation::NetworkSimulation* simulation;",
    "canopen/host/plant_text.hpp": "auto* text = &canopen::fault_text;",
    "canopen/host/simulated_device.hpp": "auto* run = &canopen::simulate_devices;",
    "canopen/host/simulated_node.hpp": "canopen::SimulatedNode* node;",
    "canopen/host/simulation_codec.hpp": "auto* parse = &canopen::simulation::parse_frame;",
    "canopen/host/virtual_bus.hpp": "canopen::VirtualBus bus;",
    "canopen/host/virtual_bus_port.hpp": "canopen::VirtualBusPort* port;",
    "canopen/plant/plant.hpp": "template <class Network, class Bus> using Control = canopen::Plant<Network, Bus>;",
    "canopen/plant/plant_errors.hpp": "canopen::PlantErrors errors;",
    "canopen/plant/plant_fault.hpp": "canopen::PlantFault fault;",
    "canopen/plant/plant_node.hpp": "canopen::PlantNode* node;",
    "canopen/plant/plant_place.hpp": "canopen::PlantPlace* place;",
    "canopen/plant/signal.hpp": "using Signals = canopen::SignalList<>;",
}


def main() -> int:
    source_dir = Path(sys.argv[1]).resolve()
    changes = (source_dir / "CHANGELOG.md").read_text(encoding="utf-8")
    listed = {path for row in ROW.findall(changes) for path in OLD_PATH.findall(row)}
    problems = [f"{path}: in only one of CHANGELOG.md and this test" for path in sorted(listed ^ set(USES))]
    with tempfile.TemporaryDirectory() as scratch:
        def message(path: str) -> str:
            source = Path(scratch) / f"{path.replace('/', '-')}.cpp"
            source.write_text(f"#include <{path}>\n{USES[path]}\n")
            result = compile_only(GCC, source, [source_dir / "runtime/include"], ["-fexceptions"])
            return f"{path}:\n{result.stderr}" if result.returncode != 0 or result.stderr else ""

        problems += [found for found in in_parallel(message, sorted(USES)) if found]
    print("\n".join(problems))
    print(f"{len(USES)} old paths, {len(problems)} problems")
    return 1 if problems or not listed else 0


if __name__ == "__main__":
    sys.exit(main())
