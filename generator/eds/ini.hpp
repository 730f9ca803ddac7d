/// INI lines with their places: the lexical level of CiA 306-1, clause 4.2.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// `key=value` inside a section. The views point into the source file's text; blanks around both are cut.
struct IniEntry {
  std::string_view key;
  std::string_view value;
  std::uint32_t line = 0;
  std::uint32_t key_column = 0;
  std::uint32_t value_column = 0;  ///< where the value stands, or would stand
};

struct IniSection {
  std::string_view name;  ///< blanks inside the brackets cut
  std::uint32_t line = 0;
  std::uint32_t column = 0;  ///< of the name
  std::vector<IniEntry> entries;

  /// The first entry with this key, letter case ignored; null when there is none.
  [[nodiscard]] const IniEntry* find(std::string_view key) const;
};

/// Text that says nothing about the device: a comment, a line that is neither section nor entry, or what stands behind a
/// section's name. A comment still has its `;` or `#`. Blanks around it are cut.
struct IniRemark {
  std::string_view text;
  std::uint32_t line = 0;
};

struct IniFile {
  const SourceFile* source = nullptr;
  std::vector<IniSection> sections;
  std::vector<IniRemark> remarks;  ///< in the order of the file; their lines say between which entries they stand
};

/// Reads all lines. What is neither a section, an entry, a comment nor blank is reported and becomes a remark.
[[nodiscard]] IniFile parse_ini(const SourceFile& source, Diagnostics& diagnostics);

/// Letter case ignored, ASCII only, independent of the locale.
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);
[[nodiscard]] bool starts_with_ignoring_case(std::string_view text, std::string_view start);
[[nodiscard]] bool ends_with_ignoring_case(std::string_view text, std::string_view end);

[[nodiscard]] Position key_position(const SourceFile& source, const IniEntry& entry);
[[nodiscard]] Position value_position(const SourceFile& source, const IniEntry& entry);
[[nodiscard]] Position section_position(const SourceFile& source, const IniSection& section);

}  // namespace edsc
