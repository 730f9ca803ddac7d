/// The canonical order and spelling of keys.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "eds/sections/section_keys.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

struct KeySpelling {
  std::uint64_t identity = 0;  ///< different for each known key of a section
  std::uint64_t order = 0;     ///< position among the keys of its section; equal ones remain in the order of the file
  std::string name;
  ValueKind value = ValueKind::text;
  std::uint8_t hex_digits = 1;  ///< of a number
  std::uint32_t number = 0;     ///< of a numbered key
  bool is_numbered = false;
  bool is_known = false;
};

/// The spelling of a key in a section. An unknown key is unchanged, and follows the others.
[[nodiscard]] KeySpelling spell_key(const SectionName& section, std::string_view key);

}  // namespace edsc
