/// The excerpt of a source line in a diagnostic.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

struct Excerpt {
  static constexpr std::size_t max_columns = 120;

  std::string text;               ///< printable, with `...` where the line is truncated
  std::size_t caret = 0;          ///< columns before the caret
  std::size_t caret_columns = 1;  ///< columns to underline
};

/// The excerpt around a position in `line`. Reads only the part of the line that it shows.
[[nodiscard]] Excerpt excerpt(std::string_view line, const Position& position);

}  // namespace edsc
