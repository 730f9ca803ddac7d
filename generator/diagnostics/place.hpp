/// A position in the units of an editor, and of an offset.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Line and column count from 1, columns in code points. The whole file is line 1.
struct Place {
  std::string file;  ///< empty without a file; all other members are then 0
  std::uint32_t line = 0;
  std::size_t column = 0;
  std::size_t length = 0;
};

[[nodiscard]] Place place_of(const Position& position);

/// The same place in the file that the line comes from: that of an overlay or of its base. A position in a file that is
/// not composed remains as it is.
[[nodiscard]] Position origin_of(const Position& position);

/// The position of `length` bytes at `offset` in the text of a file; at its end, the position after the last line.
[[nodiscard]] Position position_at(const SourceFile& source, std::size_t offset, std::size_t length = 1);

}  // namespace edsc
