#include "backend/cpp/views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backend/cpp/json_object.hpp"
#include "backend/cpp/lss_support.hpp"
#include "device/options/option_table.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

/// Ascending; an entry comes before its object, so that it can differ from the other entries.
ordered_json storing_rows(const Options& options) {
  std::vector<std::pair<EntryAddress, std::string>> storing;
  for (const auto& [entry, how] : options.storing) storing.emplace_back(entry, fmt::format("Storing::{}", how));
  for (const auto& [entry, sub_index] : options.stored_by) {
    storing.emplace_back(entry, fmt::format("stored_by({})", sub_index));
  }
  std::ranges::stable_sort(storing, {}, [](const auto& row) {
    return std::pair{row.first.index, row.first.sub_index ? unsigned{*row.first.sub_index} : 0x100U};
  });
  ordered_json rows = json_array(storing.size());
  for (auto& [entry, how] : storing) {
    std::string condition = fmt::format("index == 0x{:04X}", entry.index);
    if (entry.sub_index) condition += fmt::format(" && sub_index == 0x{:02X}", *entry.sub_index);
    rows.push_back(json_object("condition", std::move(condition), "storing", std::move(how)));
  }
  return rows;
}

/// The condition for entries that trigger an event: not in the option pdo.no_event.
ordered_json event_conditions(const Options& options) {
  ordered_json rows = json_array(options.no_event.size());
  for (const EntryAddress& entry : options.no_event) {
    std::string condition = fmt::format("index != 0x{:04X}", entry.index);
    if (entry.sub_index) condition = fmt::format("({} || sub_index != 0x{:02X})", condition, *entry.sub_index);
    rows.push_back(json_object("condition", std::move(condition), "separator", rows.empty() ? "" : " &&\n           "));
  }
  return rows;
}

ordered_json emergency_rows(const Options& options) {
  ordered_json rows = json_array(options.emergency_info.size());
  for (const auto& [code, bytes] : options.emergency_info) {
    rows.push_back(json_object("code", fmt::format("0x{:04X}", code), "bytes",
                               fmt::format("{{{{0x{:02X}}}}}", fmt::join(bytes, ", 0x"))));
  }
  return rows;
}

/// The value of a member of canopen::DeviceOptions.
std::string cpp_value(const RuntimeOption& option) {
  switch (option.row->form) {
    case OptionForm::flag: return option.value != 0 ? "true" : "false";
    case OptionForm::mask:
    case OptionForm::abort_code: return fmt::format("0x{:08X}", option.value);
    case OptionForm::emergency_code: return fmt::format("0x{:04X}", option.value);
    case OptionForm::can_id_range: return fmt::format("{{0x{:03X}, 0x{:03X}}}", option.value, option.last);
    case OptionForm::number:
    case OptionForm::structured: break;
  }
  return fmt::format("{}", option.value);
}

ordered_json runtime_rows(const Options& options) {
  ordered_json rows = json_array(options.runtime.size());
  for (const RuntimeOption& option : options.runtime) {
    rows.push_back(json_object("name", member_of(*option.row), "value", cpp_value(option)));
  }
  return rows;
}

/// The members of canopen::LssOptions in its order for a device with LSS; otherwise null.
ordered_json lss_view(const Device& device, const Options& options) {
  const Capabilities& capabilities = device.information.capabilities;
  if (!has_lss(device, options)) return nullptr;
  const LssSettings settings = options.lss.value_or(LssSettings{});
  std::string members = fmt::format(".bit_rates = 0x{:04X}", settings.bit_rates.value_or(lss_bit_rates(capabilities)));
  for (const OptionRow& row : options_table) {
    if (row.group.name != option_table::lss.name) continue;
    if (const auto at = settings.flags.find(std::string{row.name}); at != settings.flags.end()) {
      members += fmt::format(",\n      .{} = {}", row.name, at->second);
    }
  }
  return json_object("members", std::move(members));
}

}  // namespace

OptionsView options_view(const Device& device, const Options& options) {
  return {runtime_rows(options), event_conditions(options), emergency_rows(options), lss_view(device, options),
          storing_rows(options)};
}

}  // namespace edsc
