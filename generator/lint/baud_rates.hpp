/// The bit rates of CiA 301, 5.3.
#pragma once

#include <cstdint>

namespace edsc {

/// kbit/s
inline constexpr std::uint16_t standard_baud_rates[] = {10, 20, 50, 125, 250, 500, 800, 1000};

}  // namespace edsc
