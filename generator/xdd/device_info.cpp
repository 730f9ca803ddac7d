#include "xdd/device_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "eds/sections/section_keys.hpp"
#include "xdd/attributes.hpp"

namespace edsc {
namespace {

constexpr AttributeRow<FileInfo> file_info_rows[] = {
    {"fileName", &FileInfo::file_name},
    {"fileVersion", &FileInfo::file_version},
    {"fileCreator", &FileInfo::created_by},
    {"formatName", nullptr, AttributeForm::text, true},
    {"formatVersion", nullptr, AttributeForm::text, true},
    {"fileCreationDate", &FileInfo::creation_date, AttributeForm::date},
    {"fileCreationTime", &FileInfo::creation_time, AttributeForm::time},
    {"fileModificationDate", &FileInfo::modification_date, AttributeForm::date},
    {"fileModificationTime", &FileInfo::modification_time, AttributeForm::time},
    {"fileModifiedBy", &FileInfo::modified_by},
    {"supportedLanguages", nullptr, AttributeForm::text, true},
    {"deviceClass", nullptr},
};

/// Children of DeviceIdentity, whose text is the value. The versions there are texts, not the revision number of 1018h.
constexpr AttributeRow<DeviceInfo> identity_rows[] = {
    {"vendorName", &DeviceInfo::vendor_name},
    {"vendorID", &DeviceInfo::vendor_number, AttributeForm::identity},
    {"productName", &DeviceInfo::product_name},
    {"productID", &DeviceInfo::product_number, AttributeForm::identity},
    {"revisionNumber", &DeviceInfo::revision_number, AttributeForm::identity},
    {"orderNumber", &DeviceInfo::order_code},
    {"orderCode", &DeviceInfo::order_code},
    {"vendorText", nullptr},
    {"deviceFamily", nullptr},
    {"productFamily", nullptr},
    {"productText", nullptr},
    {"version", nullptr},
    {"buildDate", nullptr},
    {"specificationRevision", nullptr},
    {"instanceName", nullptr},
};

constexpr AttributeRow<DeviceInfo> general_rows[] = {
    {"granularity", &DeviceInfo::granularity, AttributeForm::decimal},
    {"nrOfRxPDO", &DeviceInfo::nr_of_rx_pdo, AttributeForm::decimal},
    {"nrOfTxPDO", &DeviceInfo::nr_of_tx_pdo, AttributeForm::decimal},
    {"bootUpSlave", &DeviceInfo::simple_boot_up_slave, AttributeForm::flag},
    {"groupMessaging", &DeviceInfo::group_messaging, AttributeForm::flag},
    {"dynamicChannels", &DeviceInfo::dynamic_channels_supported, AttributeForm::decimal},
    {"layerSettingServiceSlave", &DeviceInfo::lss_supported, AttributeForm::flag},
    {"selfStartingDevice", nullptr},
    {"SDORequestingDevice", nullptr},
    {"ngSlave", &DeviceInfo::ng_slave, AttributeForm::flag},
    {"ngMaster", &DeviceInfo::ng_master, AttributeForm::flag},
    {"NrOfNG_MonitoredNodes", &DeviceInfo::nr_of_ng_monitored_nodes, AttributeForm::decimal},
    {"nrOfEntriesDynamic", nullptr},
};

constexpr AttributeRow<DeviceInfo> master_rows[] = {
    {"bootUpMaster", &DeviceInfo::simple_boot_up_master, AttributeForm::flag},
    {"flyingMaster", nullptr},
    {"SDOManager", nullptr},
    {"configurationManager", nullptr},
    {"layerSettingServiceMaster", &DeviceInfo::lss_master, AttributeForm::flag},
    {"ngMaster", &DeviceInfo::ng_master, AttributeForm::flag},
};

constexpr AttributeRow<DeviceCommissioning> commissioning_rows[] = {
    {"nodeID", &DeviceCommissioning::node_id, AttributeForm::decimal},
    {"nodeName", &DeviceCommissioning::node_name},
    {"actualBaudRate", &DeviceCommissioning::baudrate, AttributeForm::baud_rate},
    {"networkNumber", &DeviceCommissioning::net_number, AttributeForm::decimal},
    {"networkName", &DeviceCommissioning::network_name},
    {"CANopenManager", &DeviceCommissioning::canopen_manager, AttributeForm::flag},
    {"LSS_SerialNumber", &DeviceCommissioning::lss_serial_number},
};

constexpr std::span<const AttributeRow<FileInfo>> file_info_attributes = file_info_rows;
constexpr std::span<const AttributeRow<DeviceInfo>> identity_elements = identity_rows;
constexpr std::span<const AttributeRow<DeviceInfo>> general_attributes = general_rows;
constexpr std::span<const AttributeRow<DeviceInfo>> master_attributes = master_rows;
constexpr std::span<const AttributeRow<DeviceCommissioning>> commissioning_attributes = commissioning_rows;

constexpr std::string_view automatic_rate = "auto-baudRate";

constexpr std::size_t dummy_digits = 4;

void read_identity(XmlDocument& xml, pugi::xml_node identity, DeviceInfo& info) {
  for_each_element(identity, [&](pugi::xml_node child) {
    const auto row = std::find_if(identity_elements.begin(), identity_elements.end(), [&](const auto& known) {
      return equal_ignoring_case(known.name, local_name(child));
    });
    if (row == identity_elements.end()) {
      report_unknown_element(xml, child);
    } else if (row->field == nullptr) {
      if (row->name != "productText") note_silent(xml, child);  // its description is that of [FileInfo]
    } else if (!(info.*row->field).present) {
      info.*row->field = respell(xml, xml.text(child), row->form);
    }
  });
}

void read_baud_rates(XmlDocument& xml, pugi::xml_node baud_rate, std::vector<DeviceInfo::BaudRate>& rates) {
  for_each_element(baud_rate, [&](pugi::xml_node child) {
    const Field value = xml.value(find_attribute(child, "value"));
    const auto rate = parse_unsigned(respell(xml, value, AttributeForm::baud_rate).text);
    if (local_name(child) != "supportedBaudRate") {
      report_unknown_element(xml, child);
    } else if (rate && *rate <= 0xFFFF) {
      rates.push_back({static_cast<std::uint16_t>(*rate), {"1", value.position, true}});
    } else if (!equal_ignoring_case(value.text, automatic_rate)) {
      xml.diagnostics().warning("device-info", value.present ? value.position : xml.position(child),
                                fmt::format("{} is not a baud rate such as 500 Kbps; ignored", quote(value.text)));
    }
  });
}

/// `Dummy0005=1`: the index of a data type in hexadecimal, and whether it may be mapped.
std::optional<NumberedField> read_dummy(const Field& entry) {
  const std::size_t equals = entry.text.find('=');
  const std::string_view key = entry.text.substr(0, equals);
  if (equals == std::string_view::npos || !starts_with_ignoring_case(key, dummy_key.name)) return std::nullopt;
  const auto index = parse_hex(key.substr(dummy_key.name.size()), dummy_digits);
  if (!index || *index < dummy_key.first_number || *index > dummy_key.last_number) return std::nullopt;
  Field field = entry;
  field.text.remove_prefix(equals + 1);
  return NumberedField{*index, field};
}

}  // namespace

void read_file_info(XmlDocument& xml, pugi::xml_node body, FileInfo& info) {
  info.present = static_cast<bool>(body);
  info.position = xml.position(body);
  place_attributes(file_info_attributes, info.position, info);
  read_attributes(xml, body, file_info_attributes, info);
  const pugi::xml_node product_text = find_child(find_child(body, "DeviceIdentity"), "productText");
  if (const pugi::xml_node description = find_child(product_text, "description")) {
    info.description = xml.text(description);
  }
}

void read_device_info(XmlDocument& xml, const DeviceInfoElements& elements, DeviceInfo& info) {
  info.present = elements.identity || elements.general_features;
  info.position = xml.position(elements.identity ? elements.identity : elements.general_features);
  for (const auto& rows : {identity_elements, general_attributes, master_attributes}) {
    place_attributes(rows, info.position, info);
  }
  read_identity(xml, elements.identity, info);
  read_attributes(xml, elements.general_features, general_attributes, info);
  read_attributes(xml, elements.master_features, master_attributes, info);
  read_baud_rates(xml, elements.baud_rate, info.baud_rates);
}

std::vector<NumberedField> read_dummy_usage(XmlDocument& xml, pugi::xml_node element) {
  std::vector<NumberedField> dummies;
  for_each_element(element, [&](pugi::xml_node child) {
    const pugi::xml_attribute entry = find_attribute(child, "entry");
    if (const auto dummy = read_dummy(xml.value(entry))) {
      dummies.push_back(*dummy);
    } else {
      xml.diagnostics().warning("xml-element", xml.position(child),
                                fmt::format("{} is not a dummy such as Dummy0005=1; ignored", quote(entry.value())));
    }
  });
  return dummies;
}

void read_commissioning(XmlDocument& xml, pugi::xml_node element, DeviceCommissioning& commissioning) {
  commissioning.present = static_cast<bool>(element);
  commissioning.position = xml.position(element);
  place_attributes(commissioning_attributes, commissioning.position, commissioning);
  read_attributes(xml, element, commissioning_attributes, commissioning);
}

}  // namespace edsc
