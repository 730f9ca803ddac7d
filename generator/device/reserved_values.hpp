/// Values of the communication profile that CiA 301 reserves.
#pragma once

#include <cstdint>
#include <string_view>

namespace edsc {

/// Returns why an entry of a device must not have a value, with the clause; empty if the value is not reserved.
[[nodiscard]] std::string_view why_reserved(std::uint16_t index, std::uint8_t sub_index, std::uint64_t value);

}  // namespace edsc
