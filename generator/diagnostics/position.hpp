/// A place in a source file.
#pragma once

#include <cstdint>

namespace edsc {

class SourceFile;

/// A position in a source file. Lines and columns count from 1, columns in bytes of the UTF-8 text; line 0 means the
/// whole file, which is printed as line 1.
struct Position {
  const SourceFile* file = nullptr;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;  ///< bytes to underline
};

}  // namespace edsc
