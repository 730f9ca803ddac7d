#include "backend/cpp/information_view.hpp"

#include <string_view>

namespace edsc {
namespace {

using nlohmann::ordered_json;

template <typename Struct, typename Member>
struct ViewRow {
  const char* key;
  Member Struct::*member;
};

using Number = std::optional<std::uint32_t>;
using Flag = std::optional<bool>;

constexpr ViewRow<FileInformation, std::string> file_texts[] = {
    {"file_name", &FileInformation::file_name},
    {"file_version", &FileInformation::file_version},
    {"file_revision", &FileInformation::file_revision},
    {"eds_version", &FileInformation::eds_version},
    {"description", &FileInformation::description},
    {"creation_time", &FileInformation::creation_time},
    {"creation_date", &FileInformation::creation_date},
    {"created_by", &FileInformation::created_by},
    {"modification_time", &FileInformation::modification_time},
    {"modification_date", &FileInformation::modification_date},
    {"modified_by", &FileInformation::modified_by},
    {"last_eds", &FileInformation::last_eds},
};

constexpr ViewRow<Capabilities, Flag> device_flags[] = {
    {"simple_boot_up_master", &Capabilities::simple_boot_up_master},
    {"simple_boot_up_slave", &Capabilities::simple_boot_up_slave},
    {"group_messaging", &Capabilities::group_messaging},
    {"lss_supported", &Capabilities::lss_supported},
};

constexpr ViewRow<Capabilities, Number> device_numbers[] = {
    {"granularity", &Capabilities::granularity},
    {"dynamic_channels_supported", &Capabilities::dynamic_channels_supported},
    {"nr_of_rx_pdo", &Capabilities::nr_of_rx_pdo},
    {"nr_of_tx_pdo", &Capabilities::nr_of_tx_pdo},
    {"compact_pdo", &Capabilities::compact_pdo},
};

constexpr ViewRow<Commissioning, std::string> commissioning_texts[] = {
    {"node_name", &Commissioning::node_name},
    {"network_name", &Commissioning::network_name},
    {"node_refd", &Commissioning::node_refd},
    {"net_refd", &Commissioning::net_refd},
};

constexpr ViewRow<Commissioning, Number> commissioning_numbers[] = {
    {"baudrate", &Commissioning::baudrate},
    {"net_number", &Commissioning::net_number},
    {"lss_serial_number", &Commissioning::lss_serial_number},
};

constexpr ViewRow<DynamicChannel, Number> channel_numbers[] = {
    {"data_type", &DynamicChannel::data_type},
    {"first_index", &DynamicChannel::first_index},
    {"last_index", &DynamicChannel::last_index},
    {"process_picture_offset", &DynamicChannel::process_picture_offset},
};

constexpr ViewRow<ModuleInformation, Number> module_numbers[] = {
    {"product_version", &ModuleInformation::product_version},
    {"product_revision", &ModuleInformation::product_revision},
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
    if (is_there(from.*row.member)) view[row.key] = to_json(from.*row.member);
  }
}

ordered_json capabilities_view(const Capabilities& capabilities) {
  ordered_json view = ordered_json::object();
  if (!capabilities.order_code.empty()) view["order_code"] = capabilities.order_code;
  view["baud_rates"] = capabilities.baud_rates;
  add_members(capabilities, device_flags, view);
  add_members(capabilities, device_numbers, view);
  return view;
}

ordered_json commissioning_view(const std::optional<Commissioning>& commissioning) {
  if (!commissioning) return nullptr;
  ordered_json view = ordered_json::object();
  add_members(*commissioning, commissioning_texts, view);
  add_members(*commissioning, commissioning_numbers, view);
  if (commissioning->canopen_manager) view["canopen_manager"] = *commissioning->canopen_manager;
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
    add_members(module, module_numbers, row);
    row["comments"] = module.comments;
    supported.push_back(std::move(row));
  }
  return {{"supported", std::move(supported)}, {"connected", information.connected_modules}};
}

}  // namespace

void add_information(const Information& information, ordered_json& view) {
  ordered_json file = ordered_json::object();
  add_members(information.file, file_texts, file);
  view["file_info"] = std::move(file);
  view["device_info"] = capabilities_view(information.capabilities);
  view["commissioning"] = commissioning_view(information.commissioning);
  view["comments"] = information.comments;
  view["tools"] = tools_view(information.tools);
  view["dynamic_channels"] = channels_view(information.dynamic_channels);
  view["modules"] = modules_view(information);
}

}  // namespace edsc
