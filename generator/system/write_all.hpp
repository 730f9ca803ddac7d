/// Writes to a file descriptor.
#pragma once

#include <string_view>

namespace edsc {

/// Writes all bytes; waits where a descriptor does not accept more bytes at once. Returns 0, or the error number.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes);

}  // namespace edsc
