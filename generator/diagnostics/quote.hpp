/// Text of a source file inside a message.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// `text` in double quotes, cut to a length that a message can bear.
[[nodiscard]] std::string quote(std::string_view text);

}  // namespace edsc
