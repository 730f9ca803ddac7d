/// What each sub-index of 1010h stores and each of 1011h restores (CiA 301, 7.5.2.13 and 7.5.2.14): tables for the
/// runtime, for edsc and for the documentation.
#pragma once

#include <cstddef>
#include <cstdint>

namespace canopen {

/// Values that are stored and restored together. The numbers from `first_group` on are the sub-indices from
/// `first_group_sub_index` on.
enum class ParameterSection : std::uint8_t {
  communication,  ///< 1000h..1FFFh
  manufacturer,   ///< 2000h..5FFFh
  application,    ///< 6000h..9FFFh
  other,          ///< A000h..FFFFh
  with_node_id,   ///< entries whose stored value is valid only for the node-ID it was stored with, and that "load" does
                  ///< not affect
  configuration,  ///< 1020h
  first_group,    ///< the entries that the device's options assign to sub-index 5
};
inline constexpr std::size_t parameter_sections = 16;
inline constexpr std::uint8_t first_group_sub_index = 5;
inline constexpr std::uint8_t last_group_sub_index = 14;

/// Bit n is section n.
using SectionSet = std::uint16_t;
[[nodiscard]] constexpr SectionSet set_of(ParameterSection section) {
  return static_cast<SectionSet>(1u << static_cast<unsigned>(section));
}
inline constexpr SectionSet all_sections = (1u << parameter_sections) - 1;

/// The sections of 1000h..1FFFh.
inline constexpr SectionSet communication_sections = set_of(ParameterSection::communication) |
                                                     set_of(ParameterSection::with_node_id) |
                                                     set_of(ParameterSection::configuration);

/// A sub-index of 1010h and 1011h. Those after the rows store the entries that the options of the device assign to
/// them, or belong to the application.
struct ParameterRange {
  std::uint8_t sub_index;
  SectionSet sections;
  const char* stores;
};
inline constexpr ParameterRange parameter_ranges[] = {
    {1, all_sections, "all parameters"},
    {2, communication_sections, "those of 1000h..1FFFh"},
    {3, set_of(ParameterSection::application), "those of 6000h..9FFFh"},
    {4, set_of(ParameterSection::manufacturer), "those of 2000h..5FFFh that no sub-index from 05h on stores"},
};

/// Returns the sections of a sub-index of 1010h and 1011h; 0: none.
[[nodiscard]] constexpr SectionSet sections_of(std::uint8_t sub_index) {
  for (const ParameterRange& row : parameter_ranges) {
    if (row.sub_index == sub_index) return row.sections;
  }
  if (sub_index < first_group_sub_index || sub_index > last_group_sub_index) return 0;
  const unsigned group = sub_index - unsigned{first_group_sub_index};
  return static_cast<SectionSet>(set_of(ParameterSection::first_group) << group);
}

namespace parameter_detail {

struct SectionRow {
  std::uint16_t last;
  ParameterSection section;
};
inline constexpr SectionRow section_rows[] = {
    {0x101F, ParameterSection::communication}, {0x1020, ParameterSection::configuration},
    {0x1FFF, ParameterSection::communication}, {0x5FFF, ParameterSection::manufacturer},
    {0x9FFF, ParameterSection::application},   {0xFFFF, ParameterSection::other},
};

/// Returns the section of the entries of an object, unless the options of the device say otherwise.
[[nodiscard]] constexpr ParameterSection section_of(std::uint16_t index) {
  const SectionRow* row = section_rows;
  while (index > row->last) ++row;
  return row->section;
}

struct IndexRange {
  std::uint16_t first;
  std::uint16_t last;
};

/// Writable objects of the communication profile that are not parameters: errors, time stamps, commands.
inline constexpr IndexRange no_parameters[] = {
    {0x1001, 0x1003}, {0x1010, 0x1011}, {0x1013, 0x1013}, {0x1023, 0x1026}, {0x1F50, 0x1F57}, {0x1F82, 0x1F83},
};

[[nodiscard]] constexpr bool can_be_parameter(std::uint16_t index) {
  for (const IndexRange& row : no_parameters) {
    if (index >= row.first && index <= row.last) return false;
  }
  return true;
}

}  // namespace parameter_detail
}  // namespace canopen
