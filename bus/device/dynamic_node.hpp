/// A node whose EDS is loaded at run time, with the protocol services of the runtime.
#pragma once

#include <canopen/host/simulated_node.hpp>
#include <memory>
#include <string>

#include "device/sheet.hpp"

namespace edsc {

/// Makes a node with this sheet, which it keeps. LSS uses `memory`, and so do the stored values of 1010h, unless `file`
/// names a file for them. Bus and memory must outlive the node. A DOMAIN has memory for 1024 bytes, of which 16 are its
/// value if it can be read.
[[nodiscard]] std::unique_ptr<canopen::SimulatedNode> make_dynamic_node(std::shared_ptr<const Sheet> sheet,
                                                                        canopen::SimulatedBus& bus,
                                                                        canopen::SimulatedMemory& memory,
                                                                        const std::string& file = {});

}  // namespace edsc
