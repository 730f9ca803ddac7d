/// fmt::format for texts that are made by the ten thousand: its format is read when edsc is compiled.
#pragma once

#include <fmt/compile.h>
#include <fmt/format.h>

#include <string>

namespace edsc {

/// `format` is FMT_COMPILE("..."). Formats into a buffer first: fmt::format would let the string grow piece by piece.
template <class Format, class... Values>
[[nodiscard]] std::string compiled_format(const Format& format, const Values&... values) {
  fmt::memory_buffer buffer;
  fmt::format_to(fmt::appender{buffer}, format, values...);
  return {buffer.data(), buffer.size()};
}

}  // namespace edsc
