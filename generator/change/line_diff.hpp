/// The differences of two texts by their lines.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "change/text_edit.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// Edits that make the lines of `after` of the lines of `before`; line ends are not compared. New lines have no origin.
[[nodiscard]] std::vector<TextEdit> line_edits(const SourceFile& before, const SourceFile& after);

/// Edits as a unified diff with three lines of context; empty without edits.
[[nodiscard]] std::string unified_diff(const SourceFile& before, const std::vector<TextEdit>& edits,
                                       std::string_view name);

}  // namespace edsc
