/// Reading the keys of a section into the members of a struct, by a table.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/duplicates.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// A key and its destination; null for a known key without effect on the device.
template <typename Struct>
struct KeyRow {
  std::string_view name;
  Field Struct::*field;
};

struct KeyMatch {
  bool is_known = false;
  Field* field = nullptr;
};

template <typename Struct>
[[nodiscard]] KeyMatch find_key(std::span<const KeyRow<Struct>> table, std::string_view key, Struct& target) {
  for (const KeyRow<Struct>& row : table) {
    if (equal_ignoring_case(row.name, key)) {
      return {true, row.field == nullptr ? nullptr : &(target.*row.field)};
    }
  }
  return {};
}

/// Sets the position of each field, in case it is missing.
template <typename Struct>
void place_fields(std::span<const KeyRow<Struct>> table, const Position& position, Struct& target) {
  for (const KeyRow<Struct>& row : table) {
    if (row.field != nullptr) {
      (target.*row.field).position = position;
    }
  }
}

[[nodiscard]] Field make_field(const SourceFile& source, const IniEntry& entry);

/// Returns the field of `number`; adds one if necessary.
[[nodiscard]] Field& numbered_field(std::vector<NumberedField>& fields, std::uint32_t number);

/// Returns the number after `prefix`: 3 in `Line3`. Nothing for any other key.
[[nodiscard]] std::optional<std::uint32_t> number_behind(std::string_view prefix, std::string_view key);

/// `known` are the keys of the section, for a suggestion in the message.
void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        std::span<const std::string_view> known, Diagnostics& diagnostics);

inline void append_names(std::vector<std::string_view>& names, std::string_view name) { names.push_back(name); }

template <typename Struct>
void append_names(std::vector<std::string_view>& names, std::span<const KeyRow<Struct>> table) {
  for (const KeyRow<Struct>& row : table) names.push_back(row.name);
}

/// Stores each value at the destination that `find` returns as a KeyMatch for its key. `known` are names and tables of
/// the keys that it finds.
template <typename Find, typename... Known>
void read_keys(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics, Find find,
               const Known&... known) {
  for (const IniEntry& entry : section.entries) {
    const KeyMatch match = find(entry.key);
    if (!match.is_known) {
      std::vector<std::string_view> names;
      (append_names(names, known), ...);
      report_unknown_key(source, section, entry, names, diagnostics);
    } else if (match.field != nullptr && match.field->present) {
      report_duplicate_key(source, entry, match.field->position, diagnostics);
    } else if (match.field != nullptr) {
      *match.field = make_field(source, entry);
    }
  }
}

}  // namespace edsc
