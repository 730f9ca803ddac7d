/// The keys that CiA 306-1 knows, section by section: order, spelling, and what their values are.
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
  std::uint32_t order = 0;  ///< where the key stands among those of its section
  std::string name;
  ValueKind value = ValueKind::text;
  std::uint8_t hex_digits = 1;  ///< of a number
  std::uint32_t number = 0;     ///< of a numbered key
  bool is_known = false;
};

/// How a key of a section of this kind is spelled. One that CiA 306 does not know stays as it is, behind the others.
[[nodiscard]] KeySpelling spell_key(SectionKind section, std::string_view key);

/// The section's title as CiA 306 spells it; `title` itself for one that CiA 306 does not know.
[[nodiscard]] std::string spell_title(const SectionName& name, std::string_view title);

}  // namespace edsc
