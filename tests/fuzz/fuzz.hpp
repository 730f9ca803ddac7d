/// Shared by the fuzz targets.
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

/// Ends the run like a crash if something that must always hold does not.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Prints the findings; they must not contain hidden characters of the file.
inline void print(const Diagnostics& diagnostics) {
  std::string text;
  print_text(text, diagnostics, {.colour = true, .all = true});
  for (std::size_t end = 0; (end = text.find("\x1B[")) != std::string::npos;) {
    text.erase(end, text.find('m', end) - end + 1);  // written by edsc itself
  }
  for (std::string_view rest = text; !rest.empty(); rest.remove_prefix(first_sequence(rest).length)) {
    require(rest.front() == '\n' || first_sequence(rest).is_visible, "findings hold no hidden characters of the file");
  }
}

}  // namespace edsc::fuzz
