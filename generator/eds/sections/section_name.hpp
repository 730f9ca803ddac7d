/// The meaning of a section name (CiA 306-1, clauses 4.4 to 4.9, 5.3 and 6).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"
#include "text/reading_choices.hpp"

namespace edsc {

struct SectionName {
  SectionKind kind = SectionKind::unknown;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint16_t number = 0;                 ///< of a tool or module
  SectionKind part = SectionKind::unknown;  ///< of `module_fixed_object`: the kind of its object section
  std::string_view remark{};                ///< for `malformed`: the fault; otherwise how CiA 306 differs, or empty
};

struct NamedSection {
  SectionName name;
  const IniSection* section = nullptr;
};

/// The sections of an object, which have its index in their name.
[[nodiscard]] bool is_object_section(SectionKind kind);

/// Sections whose name has the number of a module.
[[nodiscard]] bool is_module_section(SectionKind kind);

/// [MandatoryObjects], [OptionalObjects] and [ManufacturerObjects].
[[nodiscard]] bool is_object_list(SectionKind kind);

/// Whether the section is one of CiA 306 and its name is valid.
[[nodiscard]] bool is_known(SectionKind kind);

/// Whether the name of the section is its title alone, so that a file has one of it.
[[nodiscard]] bool is_single(SectionKind kind);

/// Ignores letter case.
[[nodiscard]] SectionName read_section_name(std::string_view name,
                                            SubIndexNotation notation = SubIndexNotation::hexadecimal);

/// The name as CiA 306 spells it: `M1Fixed6000sub1`. Empty for unknown and malformed names.
[[nodiscard]] std::string spell_section_name(const SectionName& name);

/// The title of a section as CiA 306 spells it; of an object section, what follows the index. Empty if there is none.
[[nodiscard]] std::string_view section_title(SectionKind kind);

/// Names with the same number are the same section, of which the first in the file is used.
[[nodiscard]] std::uint64_t identity(const SectionName& name);

/// Names of sections that are candidates for a suggestion for `like`, including those of compact forms for an index.
[[nodiscard]] std::vector<std::string> known_section_names(std::string_view like);

}  // namespace edsc
