/// The canonical order and spelling of keys and section titles.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "eds/sections/section_keys.hpp"
#include "eds/sections/section_name.hpp"

namespace edsc {

struct KeySpelling {
  std::uint32_t order = 0;  ///< position among the keys of its section
  std::string name;
  ValueKind value = ValueKind::text;
  std::uint8_t hex_digits = 1;  ///< of a number
  std::uint32_t number = 0;     ///< of a numbered key
  bool is_known = false;
};

/// The spelling of a key in a section of this kind. An unknown key is unchanged, and follows the others.
[[nodiscard]] KeySpelling spell_key(SectionKind section, std::string_view key);

/// The section title as CiA 306 spells it; `title` itself if unknown.
[[nodiscard]] std::string spell_title(const SectionName& name, std::string_view title);

}  // namespace edsc
