#include "eds/sections/other_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "eds/number.hpp"
#include "eds/sections/duplicates.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc {
namespace {

void check_count(const SourceFile& source, const IniSection& list, std::size_t tools, Diagnostics& diagnostics) {
  Field items;
  read_keys(
      source, list, diagnostics,
      [&](std::string_view key) { return equal_ignoring_case(key, tool_count_key.name) ? &items : nullptr; },
      tool_count_key.name);
  const std::optional<std::uint64_t> count = number_of(items);
  if (!count || *count != tools) {
    diagnostics.warning("tools", items.present ? items.position : section_position(source, list),
                        fmt::format("{} must be the number of sections [ToolX], {}", tool_count_key.name, tools));
  }
}

}  // namespace

std::vector<Tool> read_tools(const SourceFile& source, const IniSection* list, std::span<const NamedSection> sections,
                             Diagnostics& diagnostics) {
  std::map<std::uint16_t, const IniSection*> by_number;
  for (const NamedSection& section : sections) {
    const auto [first, is_new] = by_number.try_emplace(section.name.number, section.section);
    if (!is_new) {
      report_duplicate_section(source, *section.section, *first->second, diagnostics);
    }
  }
  std::vector<Tool> tools;
  for (const auto& [number, section] : by_number) {
    Tool& tool = tools.emplace_back();
    tool.number = number;
    place_fields(tool_keys, section_position(source, *section), tool);
    read_keys(
        source, *section, diagnostics, [&](std::string_view key) { return find_key(tool_keys, key, tool); }, tool_keys);
  }
  if (list != nullptr) {
    check_count(source, *list, tools.size(), diagnostics);
  } else if (!tools.empty()) {
    diagnostics.warning("tools", section_position(source, *sections[0].section), "missing section [Tools] for [ToolX]");
  }
  return tools;
}

}  // namespace edsc
