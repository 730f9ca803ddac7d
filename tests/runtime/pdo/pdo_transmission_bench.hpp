/// A device with event-driven and synchronous PDOs.
#pragma once

#include <pdo_device/device.hpp>

#include "support/bench.hpp"

namespace transmission_bench {

using Bench = bench::Bench<pdo_device::Device>;

inline constexpr auto sync = "080";

/// Operational; the PDOs that it sends on entering have been removed. TPDO2 (type 0) has sent its first data.
struct Running : Bench {
  Running() {
    ask(bench::start);
    ask(sync);
  }
};

}  // namespace transmission_bench
