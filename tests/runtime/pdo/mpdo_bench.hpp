/// A device with multiplex PDOs.
#pragma once

#include <mpdo_device/device.hpp>

#include "support/bench.hpp"

namespace mpdo_bench {

using Bench = bench::Bench<mpdo_device::Device>;

/// Operational. RPDO1 (205h) and TPDO2 (285h) are in destination addressing mode, RPDO2 (305h) and TPDO1 (185h) in
/// source addressing mode; RPDO3 and TPDO3 are not valid, and their mapping is dynamic.
struct Running : Bench {
  Running() { ask(bench::start); }
};

}  // namespace mpdo_bench
