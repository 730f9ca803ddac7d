/// The servo drive cpc TC1 as node 5, for the tests of manual 000.
#pragma once

#include <cpc_tc1/device.hpp>
#include <cstdint>

#include "manual_bench.hpp"

namespace manual_000 {

using Drive = bench::Bench<cpc_tc1::Device>;

/// Leaves one TPDO valid, sets its transmission type and event timer, and starts the drive.
inline void start_with(Drive& drive, std::uint16_t tpdo, std::uint32_t type, std::uint32_t event_timer = 0) {
  using manual::write;
  for (std::uint16_t other = 0x1800; other <= 0x1803; ++other) {
    if (other != tpdo) write(drive, other, 1, 4, 0xC000'0000);
  }
  write(drive, tpdo, 2, 1, type);
  write(drive, tpdo, 5, 2, event_timer);
  drive.ask(bench::start);
  drive.pass({});
}

}  // namespace manual_000
