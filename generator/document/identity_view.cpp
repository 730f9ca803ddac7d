#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "device/bit_rates.hpp"
#include "document/views.hpp"
#include "system/path.hpp"

namespace edsc::document {
namespace {

std::string yes_or_no(const std::optional<bool>& flag) { return !flag ? "" : *flag ? "yes" : "no"; }

std::string number(const std::optional<std::uint32_t>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string hexadecimal(std::uint32_t value) { return fmt::format("0x{:08X}", value); }

std::string date(const std::string& day, const std::string& time, const std::string& by) {
  std::string text = day + (day.empty() || time.empty() ? "" : " ") + time;
  if (!by.empty()) text += (text.empty() ? "by " : " by ") + by;
  return text;
}

/// `0x00020192: CiA 402` of the device type, 1000h.
std::string device_type(const Device& device) {
  const Entry* const entry = device.find(0x1000, 0);
  if (entry == nullptr || !entry->default_value) return "";
  const std::uint64_t value = entry->default_value->bits;
  const std::uint64_t profile = value & 0xFFFF;
  return fmt::format("0x{:08X}, {}", value, profile == 0 ? "no device profile" : fmt::format("CiA {}", profile));
}

std::size_t count_pdos(const Device& device, PdoDirection direction) {
  return static_cast<std::size_t>(std::ranges::count(device.pdos, direction, &Pdo::direction));
}

Json identity_rows(const Device& device) {
  const Capabilities& info = device.information.capabilities;
  Json rows = Json::array();
  add_property(rows, "Vendor", device.vendor_name);
  add_property(rows, "Vendor-ID", hexadecimal(device.vendor_number));
  add_property(rows, "Product", device.product_name);
  add_property(rows, "Product code", hexadecimal(device.product_number));
  add_property(rows, "Revision", hexadecimal(device.revision_number));
  add_property(rows, "Order code", info.order_code);
  add_property(rows, "Device type", device_type(device));
  add_property(rows, "Node-ID", device.node_id ? fmt::format("{}", *device.node_id) : "");
  return rows;
}

/// Whether the device has one of the objects of a range.
bool has_object(const Device& device, std::uint16_t first, std::uint16_t last) {
  return std::ranges::any_of(device.objects,
                             [&](const Object& object) { return object.index >= first && object.index <= last; });
}

struct ServiceRow {
  const char* name;
  std::uint16_t first, last;
};

/// Services that a device has if it has their object (CiA 301, 7.5.2).
constexpr ServiceRow service_objects[] = {
    {"SYNC", 0x1005, 0x1005},
    {"TIME", 0x1012, 0x1012},
    {"EMCY", 0x1014, 0x1014},
    {"Heartbeat producer", 0x1017, 0x1017},
    {"Heartbeat consumer", 0x1016, 0x1016},
    {"Node guarding", 0x100C, 0x100C},
    {"Store parameters", 0x1010, 0x1010},
    {"Restore default parameters", 0x1011, 0x1011},
    {"SDO client", 0x1280, 0x12FF},
};

Json service_rows(const Device& device) {
  const Capabilities& info = device.information.capabilities;
  Json rows = Json::array();
  add_property(rows, "RPDOs", fmt::format("{}", count_pdos(device, PdoDirection::receive)));
  add_property(rows, "TPDOs", fmt::format("{}", count_pdos(device, PdoDirection::transmit)));
  add_property(rows, "PDO granularity", info.granularity ? fmt::format("{} bit", *info.granularity) : "");
  for (const ServiceRow& row : service_objects) {
    add_property(rows, row.name, has_object(device, row.first, row.last) ? "yes" : "no");
  }
  add_property(rows, "LSS", yes_or_no(info.lss_supported));
  add_property(rows, "Boot-up master", yes_or_no(info.simple_boot_up_master));
  add_property(rows, "Boot-up slave", yes_or_no(info.simple_boot_up_slave));
  add_property(rows, "Group messaging", yes_or_no(info.group_messaging));
  add_property(rows, "Dynamic channels", number(info.dynamic_channels_supported));
  return rows;
}

Json file_rows(const Device& device, const CppNames& names) {
  const FileInformation& file = device.information.file;
  Json rows = Json::array();
  add_property(rows, "File", file_name_of(device.source->name()));
  add_property(rows, "Description", file.description);
  add_property(rows, "Version", file.file_version);
  add_property(rows, "File revision", file.file_revision);
  add_property(rows, "EDS version", file.eds_version);
  add_property(rows, "Created", date(file.creation_date, file.creation_time, file.created_by));
  add_property(rows, "Modified", date(file.modification_date, file.modification_time, file.modified_by));
  add_property(rows, "Made from", file.last_eds);
  add_property(rows, "C++ namespace", names.space());
  return rows;
}

Json commissioning_rows(const std::optional<Commissioning>& commissioning) {
  Json rows = Json::array();
  if (!commissioning) return rows;
  add_property(rows, "Node name", commissioning->node_name);
  add_property(rows, "Bit rate", commissioning->baudrate ? fmt::format("{} kbit/s", *commissioning->baudrate) : "");
  add_property(rows, "Network", commissioning->network_name);
  add_property(rows, "Network number", number(commissioning->net_number));
  add_property(rows, "LSS serial number", number(commissioning->lss_serial_number));
  add_property(rows, "CANopen manager", yes_or_no(commissioning->canopen_manager));
  return rows;
}

Json bit_rate_rows(const Device& device) {
  const std::vector<std::uint16_t>& supported = device.information.capabilities.baud_rates;
  std::vector<std::uint16_t> all{bit_rates.begin(), bit_rates.end()};
  all.insert(all.end(), supported.begin(), supported.end());
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  Json rows = Json::array();
  for (const std::uint16_t rate : all) {
    const bool is_supported = std::ranges::binary_search(supported, rate);
    rows.push_back({{"rate", rate}, {"supported", is_supported}});
  }
  return rows;
}

}  // namespace

void add_identity(const DeviceToDocument& input, Json& view) {
  const Device& device = input.device();
  view["title"] =
      device.product_name.empty() ? file_name_of(device.source->name()) : std::string_view{device.product_name};
  view["network"] = nullptr;
  if (input.node != nullptr) {
    view["title"] = input.node->node.name;
    view["network"] = {{"network_name", input.node->network},
                       {"network_page", url_of(input.node->page)},
                       {"network_node_id", input.node->node.node_id}};
  }
  view["vendor"] = shown(device.vendor_name);
  view["source"] = file_name_of(device.source->name());
  view["identity"] = identity_rows(device);
  view["services"] = service_rows(device);
  view["file"] = file_rows(device, *input.loaded.names);
  view["commissioning"] = commissioning_rows(device.information.commissioning);
  view["has_commissioning"] = !view["commissioning"].empty();
  view["bit_rates"] = bit_rate_rows(device);
  view["comments"] = device.information.comments;
  view["has_comments"] = !device.information.comments.empty();
}

}  // namespace edsc::document
