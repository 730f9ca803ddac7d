/// The meaning of a section name (CiA 306-1, clauses 4.4 to 4.9, 5.3 and 6).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

struct IniSection;

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
  object_links,         ///< [1003ObjectLinks]
  tools,
  tool,  ///< [Tool1]
  dynamic_channels,
  supported_modules,
  connected_modules,
  module_info,           ///< [M1ModuleInfo]
  module_comments,       ///< [M1Comments]
  module_fixed_objects,  ///< [M1FixedObjects]
  module_fixed_object,   ///< [M1Fixed6000], [M1Fixed6000sub1] and the other sections of objects
  module_sub_extends,    ///< [M1SubExtends]
  module_sub_extension,  ///< [M1SubExt6000]
  malformed,             ///< meant for an object, but without a valid index or sub-index
  unknown
};

struct SectionName {
  SectionKind kind = SectionKind::unknown;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  bool has_short_index = false;             ///< an index of fewer than four digits
  std::uint16_t number = 0;                 ///< of a tool or module
  SectionKind part = SectionKind::unknown;  ///< of `module_fixed_object`: the kind of its object section
  std::string_view remark{};                ///< for `malformed`: the fault
};

struct NamedSection {
  SectionName name;
  const IniSection* section = nullptr;
};

/// The sections of an object, which have its index in their name.
[[nodiscard]] constexpr bool is_object_section(SectionKind kind) {
  return kind >= SectionKind::object && kind <= SectionKind::object_links;
}

/// [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects].
[[nodiscard]] constexpr bool is_object_list(SectionKind kind) {
  return kind >= SectionKind::mandatory_objects && kind <= SectionKind::manufacturer_objects;
}

/// The name of a section as CiA 306 spells it; of an object section, what follows the index. Empty if there is none.
[[nodiscard]] std::string_view section_title(SectionKind kind);

/// Ignores letter case.
[[nodiscard]] SectionName read_section_name(std::string_view name);

/// Names of sections that are candidates for a suggestion for `like`, including those of compact forms for an index.
[[nodiscard]] std::vector<std::string> known_section_names(std::string_view like);

}  // namespace edsc
