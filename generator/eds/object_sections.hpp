/// The sections of the objects: [HHHH], [HHHHsubHH], [HHHHName], [HHHHValue], [HHHHDenotation].
#pragma once

#include <cstdint>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "eds/section_name.hpp"
#include "text/ini.hpp"

namespace edsc {

struct ObjectSection {
  SectionName name;
  const IniSection* section = nullptr;

  /// Sorting by it brings those of one index together: the object's own before its sub-objects before the lists of a
  /// compact form.
  [[nodiscard]] std::uint32_t order() const {
    return (std::uint32_t{name.index} << 16U) | (static_cast<std::uint32_t>(name.kind) << 8U) | name.sub_index;
  }
};

/// Makes objects of their sections, which may come in any order. Ascending by index, each index once.
[[nodiscard]] std::vector<ObjectDescription> read_objects(const SourceFile& source, std::vector<ObjectSection> sections,
                                                          Diagnostics& diagnostics);

}  // namespace edsc
