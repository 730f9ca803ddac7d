#include "backend/json/information_view.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "device/information_rows.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

namespace rows = information_rows;

/// A member of a DynamicChannel, by its name in the view.
struct ChannelRow {
  const char* name;
  std::optional<std::uint32_t> DynamicChannel::*to;
};

constexpr ChannelRow channel_numbers[] = {
    {"data_type", &DynamicChannel::data_type},
    {"first_index", &DynamicChannel::first_index},
    {"last_index", &DynamicChannel::last_index},
    {"process_picture_offset", &DynamicChannel::process_picture_offset},
};

bool is_there(std::string_view text) { return !text.empty(); }

template <typename T>
bool is_there(const std::optional<T>& value) {
  return value.has_value();
}

ordered_json to_json(std::string_view text) { return text; }

template <typename T>
ordered_json to_json(const std::optional<T>& value) {
  return *value;
}

/// Adds the values that the data sheet states.
template <typename Struct, typename Rows>
void add_members(const Struct& from, const Rows& rows, ordered_json& view) {
  for (const auto& row : rows) {
    if (is_there(from.*row.to)) view[row.name] = to_json(from.*row.to);
  }
}

ordered_json capabilities_view(const Capabilities& capabilities) {
  ordered_json view = ordered_json::object();
  if (!capabilities.order_code.empty()) view["order_code"] = capabilities.order_code;
  view["baud_rates"] = capabilities.baud_rates;
  add_members(capabilities, rows::device_flags, view);
  add_members(capabilities, rows::device_numbers, view);
  return view;
}

ordered_json commissioning_view(const std::optional<Commissioning>& commissioning) {
  if (!commissioning) return nullptr;
  ordered_json view = ordered_json::object();
  add_members(*commissioning, rows::commissioning_texts, view);
  add_members(*commissioning, rows::commissioning_numbers, view);
  add_members(*commissioning, rows::commissioning_flags, view);
  return view;
}

ordered_json tools_view(const std::vector<ToolInformation>& tools) {
  ordered_json view = ordered_json::array();
  for (const ToolInformation& tool : tools) view.push_back({{"name", tool.name}, {"command", tool.command}});
  return view;
}

ordered_json channels_view(const std::vector<DynamicChannel>& channels) {
  ordered_json view = ordered_json::array();
  for (const DynamicChannel& channel : channels) {
    ordered_json row = ordered_json::object();
    add_members(channel, channel_numbers, row);
    row["direction"] = channel.direction;
    view.push_back(std::move(row));
  }
  return view;
}

ordered_json modules_view(const Information& information) {
  ordered_json supported = ordered_json::array();
  for (const ModuleInformation& module : information.supported_modules) {
    ordered_json row = {
        {"number", module.number}, {"product_name", module.product_name}, {"order_code", module.order_code}};
    add_members(module, rows::module_numbers, row);
    row["comments"] = module.comments;
    supported.push_back(std::move(row));
  }
  return {{"supported", std::move(supported)}, {"connected", information.connected_modules}};
}

ordered_json section_view(const SectionValues& section) {
  ordered_json view = ordered_json::object();
  for (const SectionValue& one : section.values) {
    std::visit([&](const auto& value) { view[std::string{one.key}] = value; }, one.value);
  }
  return view;
}

}  // namespace

void add_information(const Information& information, ordered_json& view) {
  ordered_json file = ordered_json::object();
  add_members(information.file, rows::file_texts, file);
  view["file_info"] = std::move(file);
  view["device_info"] = capabilities_view(information.capabilities);
  view["commissioning"] = commissioning_view(information.commissioning);
  view["comments"] = information.comments;
  view["tools"] = tools_view(information.tools);
  view["dynamic_channels"] = channels_view(information.dynamic_channels);
  view["modules"] = modules_view(information);
  for (const SectionValues& section : information.sections) {
    view["sections"][std::string{section.title}] = section_view(section);
  }
}

}  // namespace edsc
