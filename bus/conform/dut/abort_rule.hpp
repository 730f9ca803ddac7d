/// Abort codes that a case accepts: those of CiA 301, and those that the test tool of CiA accepts in addition.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/base/abort_code.hpp>

namespace edsc::conform {

/// A code of `accepted` passes with a warning. `ok` fills the rows.
struct AbortRule {
  std::array<canopen::AbortCode, 3> standard;
  std::array<canopen::AbortCode, 3> accepted;

  [[nodiscard]] constexpr bool is_standard(canopen::AbortCode code) const { return contains(standard, code); }
  [[nodiscard]] constexpr bool is_accepted(canopen::AbortCode code) const {
    return is_standard(code) || contains(accepted, code);
  }

 private:
  static constexpr bool contains(const std::array<canopen::AbortCode, 3>& codes, canopen::AbortCode code) {
    return code != canopen::ok && std::find(codes.begin(), codes.end(), code) != codes.end();
  }
};

namespace abort_rule {

using Code = canopen::AbortCode;

inline constexpr AbortRule no_object{{Code::no_object}, {Code::general}};
inline constexpr AbortRule no_sub_index{{Code::no_sub_index}, {Code::general}};
inline constexpr AbortRule read_only{{Code::read_only}, {Code::unsupported_access, Code::general}};
inline constexpr AbortRule write_only{{Code::write_only}, {Code::unsupported_access, Code::general}};
inline constexpr AbortRule command{{Code::command_specifier}, {Code::general}};
inline constexpr AbortRule too_long{{Code::length_mismatch, Code::length_too_high}, {Code::general}};
inline constexpr AbortRule too_short{{Code::length_mismatch, Code::length_too_low}, {Code::general}};
inline constexpr AbortRule too_high{{Code::value_too_high, Code::invalid_value}, {Code::general}};
inline constexpr AbortRule too_low{{Code::value_too_low, Code::invalid_value}, {Code::general}};
inline constexpr AbortRule toggle_bit{{Code::toggle_bit}, {Code::general}};
inline constexpr AbortRule block_size{{Code::block_size}, {Code::command_specifier, Code::general}};
inline constexpr AbortRule sequence_number{{Code::sequence_number}, {Code::command_specifier, Code::general}};
/// A mapping that is changed while the PDO is valid, or while its number of entries is not 0.
inline constexpr AbortRule mapping_in_use{{Code::unsupported_access, Code::device_state},
                                          {Code::not_mappable, Code::read_only, Code::general}};

/// A value that the object refuses in any state.
inline constexpr AbortRule value{{Code::invalid_value, Code::value_too_high, Code::value_too_low}, {Code::general}};
/// A value that the object refuses in its present state.
inline constexpr AbortRule state{{Code::device_state}, {Code::general}};
/// A node-ID that another entry of 1016h has already.
inline constexpr AbortRule duplicate{{Code::parameter_incompatible}, {Code::general}};
/// A write to 1010h or 1011h with a wrong signature: 0800 002xh.
inline constexpr AbortRule signature{{Code::not_stored, Code::local_control, Code::device_state},
                                     {Code::no_dictionary, Code::no_data, Code::general}};
/// An entry of 1003h above the number of errors in 1003h:00.
inline constexpr AbortRule no_error{{Code::no_data}, {Code::general}};

}  // namespace abort_rule

}  // namespace edsc::conform
