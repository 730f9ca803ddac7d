/// Quotes text of a source file in a message.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// `text` in double quotes, truncated to a reasonable length.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace edsc
