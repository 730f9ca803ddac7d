/// The generated devices that are compared with those whose EDS is loaded at run time.
#pragma once

#include <canopen_sim/simulated_node.hpp>
#include <memory>

#define EDSC_ROW(device) \
  std::unique_ptr<canopen::SimulatedNode> make_##device(canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory);
#include "generated_device_rows.inc"
#undef EDSC_ROW
