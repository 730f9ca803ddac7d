/// The error register of an EMCY message as text.
#pragma once

#include <cstdint>
#include <string>

namespace edsc {

/// `generic, communication`; `no error` if no bit is set.
void append_error_register(std::string& text, std::uint8_t error_register);

}  // namespace edsc
