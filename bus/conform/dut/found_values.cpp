#include "conform/dut/found_values.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "configure/configuration_plan.hpp"
#include "configure/configure_node.hpp"
#include "configure/read_configuration.hpp"
#include "values/value_text.hpp"

namespace edsc::conform {
namespace {

bool is_pdo_parameter(std::uint16_t index) { return index >= 0x1400 && index < 0x1C00; }

/// Returns 1600h for 1400h, and the reverse.
std::uint16_t other_parameter(std::uint16_t index) { return static_cast<std::uint16_t>(index ^ 0x0200U); }

/// The first ones, and the number of the others.
std::string titles_of(const std::vector<ConfigurationValue>& values) {
  constexpr std::size_t max_named = 8;
  std::string text;
  for (std::size_t i = 0; i < values.size() && i < max_named; ++i) {
    text += (i == 0 ? "" : ", ") + title(values[i].entry);
  }
  if (values.size() > max_named) text += fmt::format(" and {} more", values.size() - max_named);
  return text;
}

}  // namespace

void FoundValues::remember(std::uint16_t index, std::uint8_t sub_index) {
  if (changed_.contains({index, sub_index})) return;
  if (!is_pdo_parameter(index)) return remember_entry(live_entry(&sheet_, index, sub_index));
  for (const std::uint16_t parameter : {index, other_parameter(index)}) {
    const Object* const object = sheet_.find(parameter);
    if (object == nullptr) continue;
    for (const Entry& found : object->entries) {
      if (canopen::writable(found.access)) remember_entry(live_entry(sheet_, *object, found));
    }
  }
}

void FoundValues::remember_entry(const LiveEntry& wanted) {
  const Key key{wanted.index, wanted.sub_index};
  if (changed_.contains(key) || unreadable_.contains(key) || is_left_out(wanted)) return;
  const SdoOutcome outcome = edsc::upload(sdo_, wanted);
  if (outcome.done()) {
    changed_.emplace(key, outcome.bytes);
  } else if (outcome.end == SdoEnd::refused) {
    unreadable_.insert(key);
  }
}

void FoundValues::remember_before_reset() {
  was_reset_ = true;
  if (configuration_known_) return;
  configuration_known_ = true;
  NodeConfiguration found = read_configuration(sdo_, sheet_, configuration_entries(sheet_), [](std::size_t) {});
  for (ReadValue& value : found.values) {
    const bool process_data = value.entry.index >= 0x2000 && value.entry.entry->pdo_mapping;
    if (!process_data) configuration_[{value.entry.index, value.entry.sub_index}] = std::move(value.bytes);
  }
  for (const auto& [key, bytes] : changed_) configuration_[key] = bytes;
}

std::vector<std::string> FoundValues::restore(const Values& wanted, bool application) {
  std::vector<ConfigurationValue> values;
  for (const auto& [key, bytes] : wanted) values.push_back({live_entry(&sheet_, key.first, key.second), bytes, {}});
  const ConfigurationHooks hooks{[](std::size_t, std::size_t) {}, [] { return false; }};
  const Comparison comparison = compare_configuration(sdo_, values, hooks);
  if (comparison.lost) return {titles_of(values) + ": the device does not answer"};
  std::vector<bool> differs;
  std::vector<std::string> left;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool kept = values[i].entry.index >= 0x2000 && !application;
    const ComparedValue& compared = comparison.values[i];
    const bool changed = compared.differs && compared.known();
    if (compared.differs && !compared.known()) {
      const SdoOutcome& found = compared.found;
      left.push_back(fmt::format("{} was {} and can no longer be read: {}", title(values[i].entry),
                                 value_of(values[i].entry, values[i].bytes),
                                 found.end == SdoEnd::refused ? abort_text(found.code) : failure_text(found)));
    }
    differs.push_back(changed && !kept);
    if (changed && kept) {
      left.push_back(fmt::format("{} was {} and is lost by a reset; it is not written without --application",
                                 title(values[i].entry), value_of(values[i].entry, values[i].bytes)));
    }
  }
  if (std::ranges::find(differs, true) == differs.end()) return left;
  const std::vector<ConfigurationValue> to_write = values_to_write(values, differs);
  const ConfigurationResult result = configure_node(sdo_, plan_configuration(to_write, &sheet_), hooks);
  for (const ConfigurationFailure& failure : result.failures) {
    left.push_back(fmt::format("{}: {}", title(failure.entry), failure.what));
  }
  if (result.lost && left.empty()) left.push_back("the device no longer answers");
  return left;
}

std::vector<std::string> FoundValues::restore_changed(bool application) {
  Values wanted = changed_;
  if (was_reset_) {
    for (const auto& [key, bytes] : configuration_) wanted[key] = bytes;
  }
  std::vector<std::string> left;
  if (!wanted.empty()) left = restore(wanted, application);
  changed_.clear();
  was_reset_ = false;
  return left;
}

}  // namespace edsc::conform
