/// Actions on the device that do not use the bus: its inputs, its errors, its power.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace edsc::conform {

/// Each returns false if it cannot be done. The default implementation does nothing.
class Stimuli {
 public:
  Stimuli() = default;
  Stimuli(const Stimuli&) = delete;
  Stimuli& operator=(const Stimuli&) = delete;
  virtual ~Stimuli() = default;

  /// Called before a case begins.
  virtual void begin_case(std::string_view /*id*/) {}
  /// The application sets an object: a process input changes.
  [[nodiscard]] virtual bool set(std::uint16_t /*index*/, std::uint8_t /*sub_index*/,
                                 std::span<const std::uint8_t> /*value*/) {
    return false;
  }
  /// The device detects an error with this emergency error code, which sets these bits of 1001h; or the error ends.
  [[nodiscard]] virtual bool emergency(std::uint16_t /*code*/, std::uint8_t /*error_register*/) { return false; }
  [[nodiscard]] virtual bool emergency_over(std::uint8_t /*error_register*/) { return false; }
  [[nodiscard]] virtual bool power_cycle() { return false; }
  /// Whether the user has a command for the case, and it did not succeed.
  [[nodiscard]] virtual bool command_failed() const { return false; }
};

}  // namespace edsc::conform
