/// The digital inputs and outputs of the stepper drive. The manual does not print the numbers of their functions.
#pragma once

#include <array>
#include <canopen/profile/cia402_axis.hpp>
#include <cstddef>
#include <cstdint>

namespace ezd_1136_node {

/// Values of 2190h: the function of an input.
namespace input_function {
inline constexpr std::uint16_t none = 0;
inline constexpr std::uint16_t negative_limit = 1;
inline constexpr std::uint16_t positive_limit = 2;
inline constexpr std::uint16_t origin = 3;
inline constexpr std::uint16_t emergency_stop = 4;
}  // namespace input_function

/// Values of 21A4h: what an output shows.
namespace output_function {
inline constexpr std::uint16_t control_word = 0;  ///< its bit of 60FEh:01, if 60FEh:02 has the bit
inline constexpr std::uint16_t alarm = 1;
inline constexpr std::uint16_t in_position = 2;
inline constexpr std::uint16_t motor_has_power = 3;
}  // namespace output_function

inline constexpr unsigned input_count = 8;
inline constexpr unsigned output_count = 5;
/// The bit of input 1 in 60FDh, and of output 1 in 60FEh:01.
inline constexpr unsigned first_terminal_bit = 16;

/// Voltages at the input terminals, and what they mean.
class InputTerminals {
 public:
  /// The switches of the machine are wired to the first inputs, in the order of the bits of canopen::cia402::input.
  void set_switches(std::uint32_t switches, bool on) {
    levels_ = static_cast<std::uint8_t>(on ? levels_ | switches : levels_ & ~switches);
  }
  /// `number`: 1 to 8.
  void set(unsigned number, bool on) { set_switches(1u << (number - 1), on); }

  /// 2190h:01 to :08, and 21ADh, where a set bit inverts an input.
  void configure(const std::array<std::uint16_t, input_count>& functions, std::uint16_t logic) {
    functions_ = functions;
    logic_ = logic;
  }

  /// Whether an input with this function is on.
  [[nodiscard]] bool has(std::uint16_t function) const {
    for (std::size_t i = 0; i < input_count; ++i) {
      if (functions_[i] == function && (states() >> i & 1u) != 0) return true;
    }
    return false;
  }
  /// 60FDh: bits 0 to 2 are the switches, bits 16 to 23 the inputs.
  [[nodiscard]] std::uint32_t bits() const {
    namespace bit = canopen::cia402::input;
    std::uint32_t bits = std::uint32_t{states()} << first_terminal_bit;
    if (has(input_function::negative_limit)) bits |= bit::negative_limit;
    if (has(input_function::positive_limit)) bits |= bit::positive_limit;
    if (has(input_function::origin)) bits |= bit::home_switch;
    return bits;
  }

 private:
  [[nodiscard]] std::uint8_t states() const { return static_cast<std::uint8_t>(levels_ ^ logic_); }

  std::uint8_t levels_ = 0;
  std::array<std::uint16_t, input_count> functions_{input_function::negative_limit, input_function::positive_limit,
                                                    input_function::origin, input_function::emergency_stop};
  std::uint16_t logic_ = 0;
};

}  // namespace ezd_1136_node
