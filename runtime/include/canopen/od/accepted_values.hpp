/// Values that an object accepts between its limits: the modes of operation of a drive (CiA 402-2, 6060h and 6502h).
#pragma once

#include <cstdint>

namespace canopen {

/// Consecutive values of an INTEGER8.
struct ValueRange {
  std::int8_t low;
  std::int8_t high;

  [[nodiscard]] constexpr bool has(std::int8_t value) const { return value >= low && value <= high; }
};

/// A row of the table of accepted values. An object without rows accepts all values.
struct AcceptedRange {
  std::uint16_t index;
  ValueRange values;
};

/// Whether an object that is known at compile time accepts a value between its limits. Its type has the member
/// `accepted`, an array of ranges, unless it accepts all of them.
template <class O>
[[nodiscard]] constexpr bool accepts([[maybe_unused]] typename O::type value) {
  if constexpr (requires { O::accepted; }) {
    for (const ValueRange& range : O::accepted) {
      if (range.has(value)) return true;
    }
    return false;
  } else {
    return true;
  }
}

}  // namespace canopen
