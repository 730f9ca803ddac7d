/// What the name of a section says (CiA 306-1, clauses 4.4 to 4.8 and 5.3).
#pragma once

#include <cstdint>
#include <string_view>

namespace edsc {

enum class SectionKind : std::uint8_t {
  file_info,
  device_info,
  dummy_usage,
  comments,
  device_commissioning,
  mandatory_objects,
  optional_objects,
  manufacturer_objects,
  object,               ///< [1018]
  sub_object,           ///< [1018sub1]
  compact_names,        ///< [1003Name]
  compact_values,       ///< [1003Value]
  compact_denotations,  ///< [1003Denotation]
  not_used,             ///< known, but nothing is made of it
  malformed,            ///< meant for an object, but names no index or sub-index
  unknown
};

struct SectionName {
  SectionKind kind = SectionKind::unknown;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  bool has_short_index = false;  ///< an index of fewer than four digits
  std::string_view remark;       ///< for `not_used` what the section is for, for `malformed` what is wrong
};

/// Letter case is ignored.
[[nodiscard]] SectionName read_section_name(std::string_view name);

}  // namespace edsc
