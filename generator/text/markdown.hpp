/// Text for Markdown.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// Printable text for a cell of a table, with markup escaped.
[[nodiscard]] std::string markdown_text(std::string_view text);

}  // namespace edsc
