/// The text of an options file: positions of its members, and texts that name entries.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/entry_address.hpp"
#include "json/json_file.hpp"

namespace edsc {

/// `1018h` or `1018`: an index.
[[nodiscard]] std::optional<std::uint16_t> parse_index(std::string_view text);

/// `6401h:03`, or `6401h` for the whole object.
[[nodiscard]] std::optional<EntryAddress> parse_option_address(std::string_view text);

/// `1018h:04`, `1018:4` or `1018h`: an entry of the dictionary.
[[nodiscard]] std::optional<EntryKey> parse_option_entry(std::string_view text);

class OptionFile {
 public:
  OptionFile(const JsonFile& file, Diagnostics& diagnostics) : file_{file}, diagnostics_{diagnostics} {}

  [[nodiscard]] const JsonFile& json() const { return file_; }

  /// Reports a fault at the name of the member with this value, or at the element of an array. `path` names the member
  /// in the message: `lss.fastscan`; it may be empty.
  void error(const JsonFile::Json& value, std::string_view path, std::string_view message,
             std::vector<Note> notes = {});
  /// The same at a position.
  void error_at(const Position& position, std::string_view path, std::string_view message,
                std::vector<Note> notes = {});

 private:
  const JsonFile& file_;
  Diagnostics& diagnostics_;
};

}  // namespace edsc
