/// A position as an editor counts it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// Line and column count from 1, columns in code points. The file as a whole is its line 1.
struct Place {
  std::string file;  ///< empty when there is none; then all else is 0
  std::uint32_t line = 0;
  std::size_t column = 0;
  std::size_t length = 0;
};

[[nodiscard]] Place place_of(const Position& position);

}  // namespace edsc
