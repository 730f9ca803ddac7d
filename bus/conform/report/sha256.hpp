/// SHA-256 (FIPS 180-4).
#pragma once

#include <string>
#include <string_view>

namespace edsc::conform {

/// 64 hexadecimal digits, lower case, as sha256sum prints them.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace edsc::conform
