/// A number with its noun.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace edsc {

/// `1 line`, `2 lines`; `1 entry`, `2 entries` where the plural is given.
template <typename Number>
[[nodiscard]] std::string counted(Number count, std::string_view noun, std::string_view plural = {}) {
  if (count == 1) return fmt::format("{} {}", count, noun);
  return plural.empty() ? fmt::format("{} {}s", count, noun) : fmt::format("{} {}", count, plural);
}

}  // namespace edsc
