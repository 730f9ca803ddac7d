/// The keys of CiA 306-1, by section: order, spelling and kind of value.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "eds/section_name.hpp"

namespace edsc {

enum class ValueKind : std::uint8_t {
  text,
  number,
  access,
  typed,  ///< a value of the entry's data type
  count,  ///< of the entries of this section
};

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
