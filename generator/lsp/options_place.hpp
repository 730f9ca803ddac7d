/// The place of a cursor in an options file or a file of deviations.
#pragma once

#include <string>

#include "lsp/features.hpp"

namespace edsc::lsp {

/// Markdown about the option, object or case at the cursor; empty if there is nothing.
[[nodiscard]] std::string describe_options_place(const View& view, const TextPosition& at);

[[nodiscard]] Json options_completion(const View& view, const TextPosition& at);

}  // namespace edsc::lsp
