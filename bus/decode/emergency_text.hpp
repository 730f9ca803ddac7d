/// EMCY as text: error codes of CiA 301 and of device profiles, and the bits of the error register.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

/// The meaning of an emergency error code for a device of this profile (the low word of the device type): by CiA 401 or
/// CiA 402, otherwise the error class of CiA 301.
[[nodiscard]] std::string_view emergency_text(std::uint16_t code, std::uint16_t profile);

/// `generic, communication`; `no error` if no bit is set.
void append_error_register(std::string& text, std::uint8_t error_register);

}  // namespace edsc
