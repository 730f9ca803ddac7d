#include "format/storage_locations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/storage/parameter_ranges.hpp>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compare/stored_values.hpp"
#include "eds/sections/section_name.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

constexpr std::string_view comment = ";StorageLocation=";
constexpr std::string_view never_stored[] = {"RAM", "ROM"};

/// The entry of a section: `2100` or `2100sub1`.
std::optional<EntryKey> entry_of(const IniFile& ini, std::string_view section) {
  const SectionName name = read_section_name(section, ini.source->choices().sub_indices);
  if (name.kind != SectionKind::object && name.kind != SectionKind::sub_object) return std::nullopt;
  return EntryKey{name.index, name.sub_index};
}

/// The groups by entry.
std::map<EntryKey, std::string> locations_of(const IniFile& ini) {
  std::map<EntryKey, std::string> locations;
  auto remark = ini.remarks.begin();
  for (std::size_t i = 0; i < ini.sections.size(); ++i) {
    const std::uint32_t end = i + 1 < ini.sections.size() ? ini.sections[i + 1].line : UINT32_MAX;
    for (; remark != ini.remarks.end() && remark->line < end; ++remark) {
      if (remark->line <= ini.sections[i].line || !starts_with_ignoring_case(remark->text, comment)) continue;
      if (const auto entry = entry_of(ini, ini.sections[i].name)) {
        locations[*entry] = std::string{remark->text.substr(comment.size())};
      }
    }
  }
  return locations;
}

bool has_word(std::string_view text, std::string_view word) {
  const auto is_part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_part(text[at - 1])) && (end == text.size() || !is_part(text[end]))) return true;
  }
  return false;
}

/// The sub-index of 1010h whose name has the name of a group.
std::optional<std::uint8_t> sub_index_of_group(const Device& device, std::string_view group) {
  const Object* const store = device.find(0x1010);
  if (store == nullptr) return std::nullopt;
  for (const Entry& entry : store->entries) {
    const bool assignable =
        entry.sub_index >= canopen::first_group_sub_index && entry.sub_index <= canopen::last_group_sub_index;
    if (assignable && has_word(entry.parameter_name(), group)) return entry.sub_index;
  }
  return std::nullopt;
}

}  // namespace

nlohmann::ordered_json storage_options(const IniFile& ini, const Device& device, const Options& options) {
  const std::map<EntryKey, std::string> locations = locations_of(ini);
  if (locations.empty()) return nullptr;
  nlohmann::ordered_json entries = nlohmann::ordered_json::object();
  nlohmann::ordered_json sub_indices = nlohmann::ordered_json::object();
  const StoredEntries stored{{device, options}};
  const auto add_entry = [&](const std::string& label, const char* how) {
    entries.get_ref<nlohmann::ordered_json::object_t&>().emplace_back(label, how);  // labels differ
  };
  for (const auto& [key, group] : locations) {
    const Object* const object = device.find(key.first);
    const Entry* const entry = object == nullptr ? nullptr : object->find(key.second);
    if (entry == nullptr || !canopen::parameter_detail::can_be_parameter(key.first)) continue;
    const bool is_excluded = std::ranges::find(never_stored, group) != std::end(never_stored);
    const bool stores_now = stored.contains(*object, *entry);
    const std::string label = entry_label(key.first, key.second);
    if (is_excluded) {
      if (stores_now) add_entry(label, "never");
      continue;
    }
    if (!canopen::writable(entry->access)) continue;  // CANopenNode also writes constants to the storage
    const auto sub_index = key.first < 0x2000 ? std::nullopt : sub_index_of_group(device, group);
    if (sub_index) {
      sub_indices[fmt::format("{:02X}h", *sub_index)].push_back(label);
    } else if (!stores_now) {
      add_entry(label, "always");
    }
  }
  nlohmann::ordered_json storage = nlohmann::ordered_json::object();
  if (!entries.empty()) storage["entries"] = std::move(entries);
  if (!sub_indices.empty()) storage["sub_indices"] = std::move(sub_indices);
  return {{"storage", std::move(storage)}};
}

}  // namespace edsc
