/// What acts on a device from outside the bus: its inputs, its errors, its power.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace edsc::conform {

/// Each answers false where it cannot be done. The default does nothing.
class Stimuli {
 public:
  Stimuli() = default;
  Stimuli(const Stimuli&) = delete;
  Stimuli& operator=(const Stimuli&) = delete;
  virtual ~Stimuli() = default;

  /// The case that asks, before it begins.
  virtual void begin_case(std::string_view /*id*/) {}
  /// The application sets an object: a process input changes.
  [[nodiscard]] virtual bool set(std::uint16_t /*index*/, std::uint8_t /*sub_index*/,
                                 std::span<const std::uint8_t> /*value*/) {
    return false;
  }
  /// The device finds an error with this emergency error code, which sets these bits of 1001h; or it is over.
  [[nodiscard]] virtual bool emergency(std::uint16_t /*code*/, std::uint8_t /*error_register*/) { return false; }
  [[nodiscard]] virtual bool emergency_over(std::uint8_t /*error_register*/) { return false; }
  [[nodiscard]] virtual bool power_cycle() { return false; }
};

}  // namespace edsc::conform
