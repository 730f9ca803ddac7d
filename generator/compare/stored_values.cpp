#include "compare/stored_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <canopen/storage/parameter_ranges.hpp>
#include <cstddef>
#include <cstdint>

#include "compare/compare_parts.hpp"
#include "compare/print_changes.hpp"
#include "device/options/option_table.hpp"
#include "text/markdown.hpp"
#include "text/printable.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t store_parameters = 0x1010;
constexpr const OptionRow* storage_version = find_option("storage", "version");
constexpr std::string_view fates[] = {"kept", "converted", "dropped"};

std::uint32_t version_of(const Options& options) {
  const auto row = std::ranges::find(options.runtime, storage_version, &RuntimeOption::row);
  return row == options.runtime.end() ? 0 : row->value;
}

/// The fate of a value whose entry stores values in both versions.
void compare_entry(const StoringDevice& before, const StoringDevice& after, const Entry& old_entry,
                   const Entry& new_entry, StoredValueChange& value) {
  if (old_entry.type != new_entry.type) {
    value.fate = StoredFate::converted;
    value.why = fmt::format("data type {} becomes {}", old_entry.type->name, new_entry.type->name);
    return;
  }
  if (const std::uint32_t old_version = version_of(before.options), new_version = version_of(after.options);
      old_version != new_version) {
    value.why = fmt::format("storage.version {} becomes {}: the application can convert it", old_version, new_version);
    return;
  }
  if (new_entry.type->kind == canopen::DataClass::string) {
    const std::uint32_t capacity = string_capacity(new_entry, after.options);
    if (capacity < string_capacity(old_entry, before.options))
      value.why = fmt::format("a text of more than {} bytes is not loaded", capacity);
    return;
  }
  if (same_value(old_entry.low_limit, new_entry.low_limit) && same_value(old_entry.high_limit, new_entry.high_limit))
    return;
  if (!new_entry.low_limit && !new_entry.high_limit) return;
  value.why = fmt::format("a value outside {} to {} is not loaded", written_value(new_entry.low_limit, *new_entry.type),
                          written_value(new_entry.high_limit, *new_entry.type));
}

std::size_t count(const std::vector<StoredValueChange>& values, StoredFate fate) {
  return static_cast<std::size_t>(std::ranges::count(values, fate, &StoredValueChange::fate));
}

std::string summary(const std::vector<StoredValueChange>& values) {
  return fmt::format("{} kept, {} converted, {} dropped", count(values, StoredFate::kept),
                     count(values, StoredFate::converted), count(values, StoredFate::dropped));
}

}  // namespace

std::string_view to_string(StoredFate fate) { return fates[static_cast<std::size_t>(fate)]; }

StoredEntries::StoredEntries(const StoringDevice& storing) : placement_{storing.device, storing.options} {
  for (const auto& [selector, how] : storing.options.storing) {
    by_options_.try_emplace({selector.index, selector.sub_index}, how != "never");
  }
  for (const auto& [selector, sub_index] : storing.options.stored_by) {
    by_options_.try_emplace({selector.index, selector.sub_index}, true);
  }
  for (const Pdo& pdo : storing.device.pdos) {
    if (pdo.broken) continue;
    for (const PdoEntry& mapped : pdo.entries) mapped_by_default_.emplace(mapped.index, mapped.sub_index);
  }
}

bool StoredEntries::contains(const Object& object, const Entry& entry) const {
  if (placement_.place(object, entry) != MemoryPlace::ram || entry.type->kind == canopen::DataClass::domain)
    return false;
  if (const auto stored = by_options(entry)) return *stored;
  const canopen::AccessRow& access = canopen::row_of(entry.access);
  const bool is_process_data = canopen::allows(entry.mappable(), canopen::Mappable::tpdo) !=
                               canopen::allows(entry.mappable(), canopen::Mappable::rpdo);
  return access.readable && access.writable && !is_process_data &&
         canopen::parameter_detail::can_be_parameter(entry.index) &&
         !mapped_by_default_.contains({entry.index, entry.sub_index});
}

std::optional<bool> StoredEntries::by_options(const Entry& entry) const {
  for (const std::optional<std::uint8_t> sub_index : {std::optional{entry.sub_index}, std::optional<std::uint8_t>{}}) {
    const auto found = by_options_.find({entry.index, sub_index});
    if (found != by_options_.end()) return found->second;
  }
  return std::nullopt;
}

std::vector<StoredValueChange> compare_stored_values(const StoringDevice& before, const StoringDevice& after) {
  std::vector<StoredValueChange> values;
  if (before.device.find(store_parameters) == nullptr) return values;
  const bool still_stores = after.device.find(store_parameters) != nullptr;
  const StoredEntries stored_before{before};
  const StoredEntries stored_after{after};
  for (const Object& object : before.device.objects) {
    for (const Entry& entry : object.entries) {
      if (!stored_before.contains(object, entry)) continue;
      StoredValueChange value{StoredFate::kept, entry_label(entry.index, entry.sub_index),
                              entry.name,       {},
                              entry.position,   {after.device.source}};
      const Object* const new_object = after.device.find(entry.index);
      const Entry* const new_entry = new_object == nullptr ? nullptr : new_object->find(entry.sub_index);
      if (new_entry != nullptr) value.new_position = new_entry->position;
      if (new_entry == nullptr || !still_stores || !stored_after.contains(*new_object, *new_entry)) {
        value.fate = StoredFate::dropped;
        value.why = new_entry == nullptr ? "the entry does not exist any more" : "the entry is not stored any more";
      } else {
        compare_entry(before, after, entry, *new_entry, value);
      }
      values.push_back(std::move(value));
    }
  }
  return values;
}

void add_lost_values(const std::vector<StoredValueChange>& values, Changes& changes) {
  for (const StoredValueChange& value : values) {
    if (value.fate == StoredFate::kept) continue;
    Change& change = changes.add("stored-value-lost", value.entry, value.name, value.old_position, value.new_position);
    change.old_value = fmt::format("({})", value.why);
  }
}

std::string stored_values_as_text(const std::vector<StoredValueChange>& values) {
  std::string text;
  for (const StoredValueChange& value : values) {
    text += fmt::format("{}: {}: {} \"{}\"{}{} (was {})\n", printable(text_of_place(value.new_position)),
                        to_string(value.fate), value.entry, printable(value.name), value.why.empty() ? "" : ": ",
                        value.why, printable(text_of_place(value.old_position)));
  }
  return text + summary(values) + "\n";
}

std::string stored_values_as_markdown(const std::vector<StoredValueChange>& values) {
  std::string text =
      fmt::format("**Stored values**: {}\n\n| Entry | Stored value | Why |\n| --- | --- | --- |\n", summary(values));
  for (const StoredValueChange& value : values) {
    text += fmt::format("| {} {} | {} | {} |\n", value.entry, markdown_text(value.name), to_string(value.fate),
                        value.why.empty() ? "-" : markdown_text(value.why));
  }
  return text;
}

nlohmann::ordered_json stored_values_as_json(const std::vector<StoredValueChange>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const StoredValueChange& value : values) {
    list.push_back({{"entry", value.entry},
                    {"name", value.name},
                    {"fate", to_string(value.fate)},
                    {"why", value.why},
                    {"old_position", json_of_place(value.old_position)},
                    {"new_position", json_of_place(value.new_position)}});
  }
  return {{"schema", 2},
          {"stored_values", std::move(list)},
          {"kept", count(values, StoredFate::kept)},
          {"converted", count(values, StoredFate::converted)},
          {"dropped", count(values, StoredFate::dropped)}};
}

}  // namespace edsc
