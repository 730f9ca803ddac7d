/// One-byte code pages of texts that are not UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// Tells a DOS text (code page 437 or 850) from a Windows text (code page 1252) by what its non-ASCII bytes would be in
/// either, and where they stand.
[[nodiscard]] bool looks_like_cp437(std::string_view bytes);

[[nodiscard]] std::string from_cp437(std::string_view bytes);
[[nodiscard]] std::string from_cp1252(std::string_view bytes);

}  // namespace edsc
