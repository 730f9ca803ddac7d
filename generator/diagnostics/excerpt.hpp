/// The part of a source line that a diagnostic shows.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

struct Excerpt {
  static constexpr std::size_t most_columns = 120;

  std::string text;               ///< printable, `...` where the line was cut
  std::size_t caret = 0;          ///< columns before the caret
  std::size_t caret_columns = 1;  ///< how many columns to underline
};

/// The surroundings of a place in `line`. Looks at no more of the line than it shows.
[[nodiscard]] Excerpt excerpt(std::string_view line, const Position& position);

}  // namespace edsc
