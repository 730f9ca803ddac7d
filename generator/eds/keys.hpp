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

/// A key and where its value goes; null for a key that is known but says nothing about the device's function.
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

/// Gives each field the place where it is missing.
template <typename Struct>
void place_fields(std::span<const KeyRow<Struct>> table, const Position& position, Struct& target) {
  for (const KeyRow<Struct>& row : table) {
    if (row.field != nullptr) {
      (target.*row.field).position = position;
    }
  }
}

[[nodiscard]] Field make_field(const SourceFile& source, const IniEntry& entry);

/// The field of `number`; a new one when there is none yet.
[[nodiscard]] Field& numbered_field(std::vector<NumberedField>& fields, std::uint32_t number);

/// The number behind `prefix`: 3 in `Line3`. Nothing for any other key.
[[nodiscard]] std::optional<std::uint32_t> number_behind(std::string_view prefix, std::string_view key);

/// `known` are the keys of the section: the message names one that is similar.
void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        std::span<const std::string_view> known, Diagnostics& diagnostics);

inline void append_names(std::vector<std::string_view>& names, std::string_view name) { names.push_back(name); }

template <typename Struct>
void append_names(std::vector<std::string_view>& names, std::span<const KeyRow<Struct>> table) {
  for (const KeyRow<Struct>& row : table) names.push_back(row.name);
}

/// Puts each value where `find` says its key belongs; `find` takes a key and gives a KeyMatch. `known` are names and tables
/// of the keys that it finds.
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
