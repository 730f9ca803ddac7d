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
#include "text/printable.hpp"

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
  for (std::size_t end = 0; (end = text.find("\x1B[")) != std::string::npos;) {
    text.erase(end, text.find('m', end) - end + 1);  // of edsc itself
  }
  for (std::string_view rest = text; !rest.empty(); rest.remove_prefix(first_sequence(rest).length)) {
    require(rest.front() == '\n' || first_sequence(rest).is_visible, "findings hold no hidden characters of the file");
  }
}

}  // namespace edsc::fuzz
