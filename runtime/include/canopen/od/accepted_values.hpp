/// Values that an object accepts between its limits: the modes of operation of a drive (CiA 402-2, 6060h and 6502h).
#pragma once

#include <cstdint>

#include "canopen/od/object.hpp"
#include "canopen/od/typed_value.hpp"

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

/// The accepted values of one object in a form that takes few instructions to check: a bit for each value from 0 to 31,
/// and the lowest one below 0.
struct AcceptedBits {
  std::uint32_t bits = 0;
  std::int8_t lowest = 0;

  constexpr void add(ValueRange range) {
    if (range.low < lowest) lowest = range.low;
    for (int value = range.low < 0 ? 0 : range.low; value <= range.high && value < 32; ++value) {
      bits |= std::uint32_t{1} << value;
    }
  }
  [[nodiscard]] constexpr bool has(std::int8_t value) const {
    const auto bit = static_cast<std::uint8_t>(value);
    return bit < 32 ? (bits >> bit & 1) != 0 : value < 0 && value >= lowest;
  }
};

/// Whether all rows of the table are of one object.
template <class Device>
inline constexpr bool has_one_axis = Device::dictionary.accepted.front().index
                                     == Device::dictionary.accepted.back().index;

/// Whether an object that has rows in the table accepts a value.
template <class Device>
[[nodiscard]] constexpr bool accepts_mode([[maybe_unused]] std::uint16_t index, std::uint8_t value) {
  if constexpr (!has_one_axis<Device>) {
    return Device::dictionary.accepts(index, static_cast<std::int8_t>(value));
  } else {
    constexpr AcceptedBits accepted = [] {
      AcceptedBits all;
      for (const AcceptedRange& row : Device::dictionary.accepted) all.add(row.values);
      return all;
    }();
    return accepted.has(static_cast<std::int8_t>(value));
  }
}

/// Whether an object that is known at compile time accepts a value between its limits. Its type has the member
/// `accepted`, an array of ranges, unless it accepts all of them.
template <class Object>
[[nodiscard]] constexpr bool accepts([[maybe_unused]] typename Object::type value) {
  if constexpr (Meaningful<typename Object::type>) {
    return accepts<NumbersOf<Object>>(to_raw(value));
  } else if constexpr (requires { Object::accepted; }) {
    constexpr AcceptedBits accepted = [] {
      AcceptedBits all;
      for (const ValueRange& range : Object::accepted) all.add(range);
      return all;
    }();
    return accepted.has(value);
  } else {
    return true;
  }
}

}  // namespace canopen
