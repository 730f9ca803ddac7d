/// The device information of a profile: identity, features, baud rates, dummies, commissioning.
#pragma once

#include "eds/data_sheet.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// The attributes of ProfileBody, and the description of the product.
void read_file_info(XmlDocument& xml, pugi::xml_node body, FileInfo& info);

/// The elements that make up [DeviceInfo]; each may be null.
struct DeviceInfoElements {
  pugi::xml_node identity;          ///< DeviceIdentity
  pugi::xml_node general_features;  ///< CANopenGeneralFeatures
  pugi::xml_node master_features;   ///< CANopenMasterFeatures
  pugi::xml_node baud_rate;
};

void read_device_info(XmlDocument& xml, const DeviceInfoElements& elements, DeviceInfo& info);

/// dummyUsage: `<dummy entry="Dummy0005=1"/>`.
[[nodiscard]] std::vector<NumberedField> read_dummy_usage(XmlDocument& xml, pugi::xml_node element);

void read_commissioning(XmlDocument& xml, pugi::xml_node element, DeviceCommissioning& commissioning);

}  // namespace edsc
