/// A condition that must be true for a time: 6067h and 6068h, 606Dh and 606Eh, 6065h and 6066h.
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"

namespace canopen::cia402 {

class Lasting {
 public:
  /// Adds a time during which the condition was true or not.
  void step(bool is_so, Duration span) {
    if (!is_so) {
      lasted_ = Duration{0};
      there_ = false;
      return;
    }
    if (there_ && lasted_ < longest) lasted_ += span;
    there_ = true;
  }
  /// Whether the condition has been true for this many milliseconds.
  [[nodiscard]] bool lasts(std::uint16_t milliseconds) const {
    return there_ && lasted_ >= from_milliseconds(milliseconds);
  }

 private:
  static constexpr Duration longest{65'535'000};

  Duration lasted_{0};
  bool there_ = false;
};

/// Returns the distance of two positions or velocities.
[[nodiscard]] constexpr std::uint32_t distance(std::int32_t a, std::int32_t b) {
  const std::uint32_t difference = static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b);
  return a < b ? 0u - difference : difference;
}

}  // namespace canopen::cia402
