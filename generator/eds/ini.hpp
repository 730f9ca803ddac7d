/// INI lines with their positions: the lexical level of CiA 306-1, clause 4.2.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// `key=value` in a section. The views point into the text of the source file; blanks around both are removed.
struct IniEntry {
  std::string_view key;
  std::string_view value;
  std::uint32_t line = 0;
  std::uint32_t key_column = 0;
  std::uint32_t value_column = 0;  ///< of the value, also if it is empty
};

struct IniSection {
  std::string_view name;  ///< without blanks inside the brackets
  std::uint32_t line = 0;
  std::uint32_t column = 0;  ///< of the name
  std::vector<IniEntry> entries;

  /// Returns the first entry with this key, ignoring letter case, or null.
  [[nodiscard]] const IniEntry* find(std::string_view key) const;
};

/// Text without meaning for the device: a comment, a line that is neither section nor entry, or text after a section
/// header. A comment includes its `;` or `#`. Blanks around it are removed.
struct IniRemark {
  std::string_view text;
  std::uint32_t line = 0;
};

struct IniFile {
  const SourceFile* source = nullptr;
  std::vector<IniSection> sections;
  std::vector<IniRemark> remarks;  ///< in the order of the file; their lines give their place among the entries
};

/// Reads one line of a section. Nothing if it is not an entry: without `=` or key, a comment, a header.
[[nodiscard]] std::optional<IniEntry> read_ini_entry(std::string_view line, std::uint32_t number);

/// The name of the section whose header the line is; nothing for another line.
[[nodiscard]] std::optional<std::string_view> read_ini_header(std::string_view line);

/// Reads all lines. A line that is not a section, an entry, a comment or blank is reported and becomes a remark.
[[nodiscard]] IniFile parse_ini(const SourceFile& source, Diagnostics& diagnostics);

/// The value of an entry, with `rwr` and `rww` exchanged if the choices of the file say so.
[[nodiscard]] std::string_view value_of(const SourceFile& source, const IniEntry& entry);

/// Ignores letter case, ASCII only, independent of the locale.
[[nodiscard]] bool equal_ignoring_case(std::string_view a, std::string_view b);
[[nodiscard]] bool starts_with_ignoring_case(std::string_view text, std::string_view start);
[[nodiscard]] bool ends_with_ignoring_case(std::string_view text, std::string_view end);

[[nodiscard]] Position key_position(const SourceFile& source, const IniEntry& entry);
[[nodiscard]] Position value_position(const SourceFile& source, const IniEntry& entry);
[[nodiscard]] Position section_position(const SourceFile& source, const IniSection& section);

}  // namespace edsc
