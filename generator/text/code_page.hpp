/// Single-byte code pages of texts that are not UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// Distinguishes a DOS text (code page 437 or 850) from a Windows text (code page 1252) by the characters that its
/// non-ASCII bytes would be in either, and by their context.
[[nodiscard]] bool looks_like_cp437(std::string_view bytes);

[[nodiscard]] std::string from_cp437(std::string_view bytes);
[[nodiscard]] std::string from_cp1252(std::string_view bytes);

}  // namespace edsc
