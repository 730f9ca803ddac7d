/// The text of an options file: positions of its members, and texts that name entries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/options/options.hpp"

namespace edsc {

/// `1018h` or `1018`: an index.
[[nodiscard]] std::optional<std::uint16_t> parse_index(std::string_view text);

/// `6401h:03`, or `6401h` for the whole object.
[[nodiscard]] std::optional<EntrySelector> parse_entry_selector(std::string_view text);

/// `1018h:04`, `1018:4` or `1018h`: an entry of the dictionary.
[[nodiscard]] std::optional<EntryKey> parse_entry_key(std::string_view text);

class OptionFile {
 public:
  OptionFile(const SourceFile& source, Diagnostics& diagnostics) : source_{source}, diagnostics_{diagnostics} {}

  [[nodiscard]] const SourceFile& source() const { return source_; }

  /// Reports a fault in a member, given by its path: `lss.fastscan`.
  void error(std::string_view member, const std::string& message);
  /// Reports that the file is not JSON, at a byte that counts from 1, or the whole file.
  void syntax_error(std::optional<std::size_t> byte, std::string_view what);

  /// The position of the name of the first member with this path; objects in an array have the path of the array.
  [[nodiscard]] Position position_of(std::string_view member) const;
  /// The position of the first occurrence of a text.
  [[nodiscard]] Position position_of_text(std::string_view text) const;

 private:
  [[nodiscard]] Position position_at(std::size_t byte) const;

  const SourceFile& source_;
  Diagnostics& diagnostics_;
};

}  // namespace edsc
