/// Keys of sections as rows of tables, and reading them into the members of a struct.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "eds/sections/duplicates.hpp"

namespace edsc {

/// How the value of a key is written.
enum class ValueKind : std::uint8_t {
  text,
  number,
  access,
  typed,         ///< a value of the entry's data type
  index_range,   ///< `0xA080-0xA0BF`, or one index
  module_count,  ///< `n`, or `0;m`: m bits of a sub-index that several modules share
  count,         ///< of the numbered entries of this section
  parts,         ///< the number of tools, modules or segments that the file describes
};

/// The number at the end of a key.
enum class Numbering : std::uint8_t {
  none,
  decimal,  ///< `Line3`
  c,        ///< a number of the C language: `3`, `0x3`
  hex4,     ///< four hexadecimal digits: `Dummy0003`
};

/// A key as CiA 306 spells it, without its number.
struct SectionKey {
  std::string_view name;
  ValueKind value = ValueKind::text;
  std::uint8_t hex_digits = 1;  ///< of a number or of indices
  Numbering numbering = Numbering::none;
  std::uint32_t first_number = 0;
  std::uint32_t last_number = 0xFFFF'FFFF;

  [[nodiscard]] constexpr bool is_numbered() const { return numbering != Numbering::none; }
};

/// A key and its destination; null for numbered keys.
template <typename Struct>
struct KeyRow {
  SectionKey key;
  Field Struct::*field;
};

/// Returns the field of a key, or null.
template <typename Struct, std::size_t n>
[[nodiscard]] Field* find_key(const KeyRow<Struct> (&table)[n], std::string_view key, Struct& target) {
  for (const KeyRow<Struct>& row : table) {
    if (!row.key.is_numbered() && equal_ignoring_case(row.key.name, key)) return &(target.*row.field);
  }
  return nullptr;
}

/// Sets the position of each field, in case it is missing.
template <typename Struct, std::size_t n>
void place_fields(const KeyRow<Struct> (&table)[n], const Position& position, Struct& target) {
  for (const KeyRow<Struct>& row : table) {
    if (row.field != nullptr) (target.*row.field).position = position;
  }
}

[[nodiscard]] Field make_field(const SourceFile& source, const IniEntry& entry);

/// Rows with a member `number`, which are found by it while they are read in any order.
template <typename Row>
class NumberedRows {
 public:
  explicit NumberedRows(std::vector<Row>& rows) : rows_{rows} {}

  /// Returns the row of `number`; adds one if necessary. The reference is valid until the next call.
  [[nodiscard]] Row& find_or_add(std::uint32_t number) {
    const auto [at, is_new] = places_.try_emplace(number, rows_.size());
    if (is_new) rows_.emplace_back().number = number;
    return rows_[at->second];
  }

  /// Sorts the rows by their number; the last call.
  void sort() { std::ranges::sort(rows_, {}, &Row::number); }

 private:
  std::vector<Row>& rows_;
  std::unordered_map<std::uint32_t, std::size_t> places_;
};

/// Whether `key` is a key of this row, ignoring letter case: its number, 3 in `Line3`, or 0 without a number. Nothing
/// for any other key.
[[nodiscard]] std::optional<std::uint32_t> match_key(const SectionKey& row, std::string_view key);

/// The key with this number, as CiA 306 spells it.
[[nodiscard]] std::string spell_numbered_key(const SectionKey& row, std::uint32_t number);

/// `known` are the keys of the section, for a suggestion in the message.
void report_unknown_key(const SourceFile& source, const IniSection& section, const IniEntry& entry,
                        std::span<const std::string_view> known, Diagnostics& diagnostics);

inline void append_names(std::vector<std::string_view>& names, std::string_view name) { names.push_back(name); }

template <typename Struct, std::size_t n>
void append_names(std::vector<std::string_view>& names, const KeyRow<Struct> (&table)[n]) {
  for (const KeyRow<Struct>& row : table) {
    if (!row.key.is_numbered()) names.push_back(row.key.name);
  }
}

/// How the value of a key is written; text for a key that is not in the table.
inline ValueKind kind_of_key(std::string_view /*name*/, std::string_view /*key*/) { return ValueKind::text; }

template <typename Struct, std::size_t n>
ValueKind kind_of_key(const KeyRow<Struct> (&table)[n], std::string_view key) {
  for (const KeyRow<Struct>& row : table) {
    if (match_key(row.key, key)) return row.key.value;
  }
  return ValueKind::text;
}

/// Removes the quotation marks of a number or an access type.
void remove_quotes(ValueKind kind, Field& field, Diagnostics& diagnostics);

/// Stores each value in the field that `find` returns for its key, or null. `known` are names and tables of the keys
/// that it finds.
template <typename Find, typename... Known>
void read_keys(const SourceFile& source, const IniSection& section, Diagnostics& diagnostics, Find find,
               const Known&... known) {
  for (const IniEntry& entry : section.entries) {
    Field* const field = find(entry.key);
    if (field == nullptr) {
      std::vector<std::string_view> names;
      (append_names(names, known), ...);
      report_unknown_key(source, section, entry, names, diagnostics);
    } else if (field->present) {
      report_duplicate_key(source, entry, field->position, diagnostics);
    } else {
      *field = make_field(source, entry);
      if (entry.value.starts_with('"')) {
        ((remove_quotes(kind_of_key(known, entry.key), *field, diagnostics)), ...);
      }
    }
  }
}

}  // namespace edsc
