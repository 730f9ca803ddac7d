/// What the fuzz targets share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "diagnostics/diagnostics.hpp"
#include "diagnostics/print.hpp"

namespace edsc::fuzz {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the run, as a crash does, when something that always holds does not.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Findings are shown whatever they point at.
inline void print(const Diagnostics& diagnostics) {
  std::string text;
  print_text(text, diagnostics, true);
  require(text.find_first_of("\r\t") == std::string::npos, "findings hold no control characters of the file");
}

}  // namespace edsc::fuzz
