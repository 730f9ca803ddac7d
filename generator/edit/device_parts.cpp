#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>

#include "edit/sheet_parts.hpp"
#include "eds/ini.hpp"
#include "eds/sections/section_keys.hpp"

namespace edsc::edit {
namespace {

/// Keys of [DeviceInfo] with the values 0 and 1 (CiA 306-1, 4.5).
constexpr std::string_view flag_keys[] = {
    "SimpleBootUpMaster", "SimpleBootUpSlave", "DynamicChannelsSupported",
    "GroupMessaging",     "LSS_Supported",     "LSS_Master",
    "NG_Slave",           "NG_Master",         "CANopenSafetySupported",
    "CANopenManager",
};

constexpr std::uint16_t usual_bit_rates[] = {10, 20, 50, 125, 250, 500, 800, 1000};

struct IdentityField {
  std::string_view key, label, object;
};
constexpr IdentityField identity_fields[] = {
    {"VendorNumber", "Vendor-ID", "1018h:01"},
    {"ProductNumber", "Product code", "1018h:02"},
    {"RevisionNumber", "Revision number", "1018h:03"},
};

Json field_json(std::string_view key, std::string_view kind, const Field& field) {
  return {{"key", key}, {"label", key}, {"kind", kind}, {"value", field.text}, {"present", field.present}};
}

template <typename Struct, std::size_t n>
Json fields_of(const KeyRow<Struct> (&keys)[n], const Struct& section) {
  Json fields = Json::array();
  for (const KeyRow<Struct>& row : keys) {
    if (row.field == nullptr) continue;
    const std::string_view name = row.key.name;
    if (std::ranges::find(identity_fields, name, &IdentityField::key) != std::end(identity_fields)) continue;
    const bool is_flag = std::ranges::find(flag_keys, name) != std::end(flag_keys);
    const bool is_number = row.key.value == ValueKind::number;
    fields.push_back(field_json(name, is_flag ? "flag" : is_number ? "number" : "text", section.*row.field));
  }
  return fields;
}

void add_bit_rates(const DeviceInfo& info, Json& fields) {
  static constexpr Field missing{};
  for (const std::uint16_t rate : usual_bit_rates) {
    const auto found = std::ranges::find(info.baud_rates, rate, &DeviceInfo::BaudRate::kbit_per_second);
    fields.push_back(
        field_json(fmt::format("BaudRate_{}", rate), "flag", found == info.baud_rates.end() ? missing : found->field));
  }
}

Json group(SectionKind kind, Json fields) {
  return {{"title", section_title(kind)}, {"section", section_title(kind)}, {"fields", std::move(fields)}};
}

}  // namespace

void add_device(const OpenSheet& sheet, EditParts& parts) {
  const DataSheet& data = sheet.sheet;
  Json device_info = fields_of(section_keys::device_info_keys, data.device_info);
  add_bit_rates(data.device_info, device_info);
  Json groups = Json::array();
  groups.push_back(group(SectionKind::file_info, fields_of(section_keys::file_info_keys, data.file_info)));
  groups.push_back(group(SectionKind::device_info, std::move(device_info)));
  if (data.is_dcf) {
    groups.push_back(
        group(SectionKind::device_commissioning, fields_of(section_keys::commissioning_keys, data.commissioning)));
  }
  const DeviceInfo& info = data.device_info;
  Json identity = Json::array();
  for (const IdentityField& row : identity_fields) {
    const Field* field = nullptr;
    for (const KeyRow<DeviceInfo>& key : section_keys::device_info_keys) {
      if (key.field != nullptr && key.key.name == row.key) field = &(info.*key.field);
    }
    identity.push_back({{"key", row.key},
                        {"section", section_title(SectionKind::device_info)},
                        {"label", row.label},
                        {"value", field == nullptr ? std::string_view{} : field->text},
                        {"object", row.object},
                        {"kind", "number"}});
  }
  parts.set("device", {{"groups", std::move(groups)}, {"identity", std::move(identity)}});
}

}  // namespace edsc::edit
