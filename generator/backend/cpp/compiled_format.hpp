/// fmt::format with a format string that is parsed at compile time, for texts that occur ten thousand times.
#pragma once

#include <fmt/compile.h>
#include <fmt/format.h>

#include <string>

namespace edsc {

/// `format` is FMT_COMPILE("..."). Formats into a buffer first, since fmt::format would reallocate the string
/// repeatedly.
template <class Format, class... Values>
[[nodiscard]] std::string compiled_format(const Format& format, const Values&... values) {
  fmt::memory_buffer buffer;
  fmt::format_to(fmt::appender{buffer}, format, values...);
  return {buffer.data(), buffer.size()};
}

}  // namespace edsc
