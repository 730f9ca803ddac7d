/// Text of Windows, which is UTF-16, and of edsc, which is UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// Invalid UTF-8 becomes U+FFFD.
[[nodiscard]] std::wstring to_wide(std::string_view text);

/// Invalid UTF-16, such as half of a surrogate pair in the name of a file, becomes U+FFFD.
[[nodiscard]] std::string from_wide(std::wstring_view text);

}  // namespace edsc
