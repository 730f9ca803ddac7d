/// EMCY in words: error codes of CiA 301 and of device profiles, and the bits of the error register.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {

/// What an emergency error code means to a device of this profile, the low word of its device type: as precisely as CiA
/// 401 or CiA 402 say it, else by the class that CiA 301 gives it.
[[nodiscard]] std::string_view emergency_text(std::uint16_t code, std::uint16_t profile);

/// `generic, communication`; `no error` where no bit is set.
void append_error_register(std::string& text, std::uint8_t error_register);

}  // namespace edsc
