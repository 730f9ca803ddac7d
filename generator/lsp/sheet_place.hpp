/// The place of a cursor in an EDS, DCF or overlay, and the object that it means.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "device/entry_address.hpp"
#include "eds/ini.hpp"
#include "eds/sections/section_name.hpp"
#include "lsp/workspace.hpp"
#include "pdo/mapping.hpp"

namespace edsc::lsp {

struct SheetPlace {
  const IniSection* section = nullptr;  ///< null before the first one
  SectionName name;
  const IniEntry* entry = nullptr;  ///< of the line; null for another line
  bool is_in_value = false;         ///< at or after the `=` of the entry
};

/// `line` counts from 1, `column` from 1 in bytes.
[[nodiscard]] SheetPlace place_in(const IniFile& ini, std::uint32_t line, std::uint32_t column);

/// The value of an entry without a comment; of a line of an overlay, its new value.
[[nodiscard]] std::string_view current_value(const IniEntry& entry);

/// The sub-index of the value of an entry: that of the section, or of a line of `[1A00Value]`. Nothing if the entry is
/// not a value of an object.
[[nodiscard]] std::optional<EntryAddress> address_of_value(const SectionName& name, const IniEntry& entry);

/// What an entry of a mapping parameter maps; nothing for another entry, and for an empty one.
[[nodiscard]] std::optional<MappingValue> mapping_at(const SectionName& name, const IniEntry& entry);

/// The index in a line of an object list, or of `[2000ObjectLinks]`.
[[nodiscard]] std::optional<std::uint16_t> listed_index(const SectionName& name, const IniEntry& entry);

/// The object that the cursor means: that of the line of a list, of a mapping value, or of the section.
[[nodiscard]] std::optional<EntryAddress> target_of(const SheetPlace& place);

}  // namespace edsc::lsp
