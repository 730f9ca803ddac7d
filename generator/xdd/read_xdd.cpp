#include "xdd/read_xdd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "eds/number.hpp"
#include "eds/sections/object_lists.hpp"
#include "text/source_file.hpp"
#include "xdd/application_process.hpp"
#include "xdd/attributes.hpp"
#include "xdd/device_info.hpp"
#include "xdd/object_list.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {
namespace {

/// The parts of a profile that are read; null if missing.
struct Parts {
  pugi::xml_node body;  ///< of the device profile, if any
  pugi::xml_node identity, application_process;
  pugi::xml_node application_layers, object_list, dummy_usage, object_identity;
  pugi::xml_node transport_layers, physical_layer, baud_rate;
  pugi::xml_node network_management, general_features, master_features, commissioning;
};

/// The destination of a part; null for a known part without effect on the device.
struct PartRow {
  std::string_view parent;
  std::string_view name;
  pugi::xml_node Parts::*part;
};

constexpr PartRow part_rows[] = {
    {"ProfileBody", "DeviceIdentity", &Parts::identity},
    {"ProfileBody", "DeviceManager", nullptr},
    {"ProfileBody", "DeviceFunction", nullptr},
    {"ProfileBody", "ApplicationProcess", &Parts::application_process},
    {"ProfileBody", "ExternalProfileHandle", nullptr},
    {"ProfileBody", "ApplicationLayers", &Parts::application_layers},
    {"ApplicationLayers", "CANopenObjectList", &Parts::object_list},
    {"ApplicationLayers", "dummyUsage", &Parts::dummy_usage},
    {"ApplicationLayers", "identity", &Parts::object_identity},
    {"ProfileBody", "TransportLayers", &Parts::transport_layers},
    {"TransportLayers", "PhysicalLayer", &Parts::physical_layer},
    {"PhysicalLayer", "baudRate", &Parts::baud_rate},
    {"ProfileBody", "NetworkManagement", &Parts::network_management},
    {"NetworkManagement", "CANopenGeneralFeatures", &Parts::general_features},
    {"NetworkManagement", "CANopenMasterFeatures", &Parts::master_features},
    {"NetworkManagement", "deviceCommissioning", &Parts::commissioning},
};

/// xsi:type of a ProfileBody that belongs to CANopen; the modular ones are longer.
constexpr std::string_view body_types[] = {
    "ProfileBody_Device_CANopen",
    "ProfileBody_CommunicationNetwork_CANopen",
};

constexpr std::string_view container_name = "ISO15745ProfileContainer";
constexpr std::string_view profile_name = "ISO15745Profile";

std::string_view body_type(pugi::xml_node body) {
  const std::string_view type = find_attribute(body, "type").value();
  return type.substr(type.find(':') + 1);
}

class XddReader {
 public:
  XddReader(const SourceFile& source, Diagnostics& diagnostics) : xml_{source, diagnostics} { sheet_.source = &source; }

  [[nodiscard]] std::vector<NotInEds> take_not_in_eds() { return xml_.take_not_in_eds(); }

  DataSheet read() {
    if (xml_.root()) find_profiles();
    if (parts_.object_list) {
      read_parts();
    } else if (xml_.root()) {
      report_no_profile();
    }
    sheet_.texts = xml_.kept_texts();
    return std::move(sheet_);
  }

 private:
  void find_profiles() {
    if (local_name(xml_.root()) == profile_name) read_profile(xml_.root());
    if (local_name(xml_.root()) != container_name) return;
    for_each_element(xml_.root(), [&](pugi::xml_node child) {
      if (local_name(child) == profile_name) {
        read_profile(child);
      } else {
        report_unknown_element(xml_, child);
      }
    });
  }

  void read_profile(pugi::xml_node profile) {
    for_each_element(profile, [&](pugi::xml_node child) {
      if (local_name(child) == "ProfileBody" && is_canopen(child)) {
        read_body(child);
      } else if (local_name(child) != "ProfileHeader" && local_name(child) != "ProfileBody") {
        report_unknown_element(xml_, child);
      }
    });
  }

  /// The type of a body without type is determined by its children.
  bool is_canopen(pugi::xml_node body) {
    const std::string_view type = body_type(body);
    if (type.empty()) return true;
    for (const std::string_view known : body_types) {
      if (type.starts_with(known) && type.find("FD", known.size()) == std::string_view::npos) return true;
    }
    if (other_type_.empty()) other_type_ = type;
    xml_.diagnostics().note("xml-element", xml_.position(body),
                            fmt::format("profile type {} is not CANopen; ignored", quote(type)));
    return false;
  }

  void read_body(pugi::xml_node body) {
    const bool is_first = !parts_.identity;
    find_parts(body);
    if (!parts_.body || (is_first && parts_.identity)) parts_.body = body;
  }

  /// The few levels below a body have distinct names: no recursion.
  void find_parts(pugi::xml_node body) {
    find_parts_in(body);
    for (pugi::xml_node Parts::*const level :
         {&Parts::application_layers, &Parts::transport_layers, &Parts::physical_layer, &Parts::network_management}) {
      if ((parts_.*level).parent() == body || (parts_.*level).parent().parent() == body) find_parts_in(parts_.*level);
    }
  }

  void find_parts_in(pugi::xml_node parent) {
    for_each_element(parent, [&](pugi::xml_node child) {
      for (const PartRow& row : part_rows) {
        if (row.parent != local_name(parent) || row.name != local_name(child)) continue;
        if (row.part != nullptr) {
          take_part(child, parts_.*row.part);
        } else {
          note_silent(xml_, child);
        }
        return;
      }
      report_unknown_element(xml_, child);
    });
  }

  void take_part(pugi::xml_node element, pugi::xml_node& part) {
    if (!part) {
      part = element;
      return;
    }
    xml_.diagnostics().warning("duplicate-section", xml_.position(element),
                               fmt::format("duplicate element {}; using the first", local_name(element)),
                               {{xml_.position(part), "the first one"}});
  }

  /// The file of another network, by its root or by the types of its profiles; empty if it is not known.
  [[nodiscard]] std::string_view other_format() const {
    struct Row {
      std::string_view mark;
      std::string_view name;
    };
    constexpr Row roots[] = {{"EtherCATInfo", "an EtherCAT slave information file"},
                             {"IODevice", "an IO-Link device description"},
                             {"CANopenProject", "a project of a CANopen editor"}};
    constexpr Row bodies[] = {{"Powerlink", "an Ethernet POWERLINK XDD"},
                              {"CANopenFD", "a CANopen FD device description (CiA 1301)"},
                              {"CANopen_FD", "a CANopen FD device description (CiA 1301)"},
                              {"EtherNetIP", "an EtherNet/IP device description"},
                              {"ProfileBody_DeviceNet", "a DeviceNet device description"}};
    for (const Row& row : roots) {
      if (local_name(xml_.root()) == row.mark) return row.name;
    }
    for (const Row& row : bodies) {
      if (other_type_.find(row.mark) != std::string_view::npos) return row.name;
    }
    return {};
  }

  void report_no_profile() {
    if (const std::string_view format = other_format(); !format.empty()) {
      return xml_.diagnostics().error(
          "xml-profile", xml_.position(xml_.root()),
          fmt::format("this is {}, not an XDD or XDC of CiA 311; it does not describe a CANopen device", format));
    }
    const bool is_container = local_name(xml_.root()) == container_name || local_name(xml_.root()) == profile_name;
    xml_.diagnostics().error(
        "xml-profile", xml_.position(xml_.root()),
        is_container ? "no profile in this file has a CANopenObjectList; this is not an XDD or XDC of CiA 311"
                     : fmt::format("an XDD or XDC of CiA 311 begins with {}, not with {}", container_name,
                                   quote(local_name(xml_.root()))));
  }

  void read_parts() {
    read_file_info(xml_, parts_.body, sheet_.file_info);
    read_device_info(xml_, {parts_.identity, parts_.general_features, parts_.master_features, parts_.baud_rate},
                     sheet_.device_info);
    read_commissioning(xml_, parts_.commissioning, sheet_.commissioning);
    sheet_.is_dcf = sheet_.commissioning.present || ends_with_ignoring_case(xml_.source().name(), ".xdc");
    sheet_.dummy_usage = read_dummy_usage(xml_, parts_.dummy_usage);
    xml_.diagnostics().set_outline(outline_of(xml_, parts_.object_list));
    ApplicationProcess process{xml_, parts_.application_process};
    sheet_.objects = read_object_list(xml_, parts_.object_list, process);
    complete_identity();
    list_objects();
    if (sheet_.objects.empty()) {
      xml_.diagnostics().error("no-objects", xml_.position(parts_.object_list), "the object list is empty");
    }
  }

  /// VendorNumber, ProductNumber and RevisionNumber that DeviceIdentity does not state: those of the identity of
  /// ApplicationLayers, else of 1018h.
  void complete_identity() {
    struct Row {
      Field DeviceInfo::*field;
      std::string_view element;
      std::uint8_t sub_index;
    };
    constexpr Row rows[] = {{&DeviceInfo::vendor_number, "vendorID", 1},
                            {&DeviceInfo::product_number, "productID", 2},
                            {&DeviceInfo::revision_number, "revisionNumber", 3}};
    const ObjectDescription* const identity = sheet_.find(0x1018);
    for (const Row& row : rows) {
      Field& field = sheet_.device_info.*row.field;
      if (!field.empty()) continue;
      if (const pugi::xml_node element = find_child(parts_.object_identity, row.element)) {
        const Field stated = xml_.text(element);
        if (number_of(stated)) field = stated;
      }
      const SubObjectDescription* const entry = identity != nullptr ? identity->find(row.sub_index) : nullptr;
      if (field.empty() && entry != nullptr && number_of(entry->default_value)) field = entry->default_value;
    }
  }

  /// CiA 311 does not have object lists: each object is added to its list in CiA 306.
  void list_objects() {
    for (const ObjectDescription& object : sheet_.objects) {
      if (const auto list = list_of(object.index)) sheet_.listed.push_back({*list, object.index, object.position});
    }
    std::ranges::stable_sort(sheet_.listed, {}, &ListedObject::list);
  }

  XmlDocument xml_;
  std::string_view other_type_;  ///< of the first body that is not of CANopen
  Parts parts_;
  DataSheet sheet_;
};

}  // namespace

bool is_xml(const SourceFile& source) {
  const std::string_view text = source.text();
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '<';
}

DataSheet read_xdd(const SourceFile& source, Diagnostics& diagnostics, std::vector<NotInEds>* not_in_eds) {
  XddReader reader{source, diagnostics};
  DataSheet sheet = reader.read();
  if (not_in_eds != nullptr) *not_in_eds = reader.take_not_in_eds();
  return sheet;
}

std::string xdd_name_problem(const std::string& path) {
  if (!ends_with_ignoring_case(path, ".xdd") && !ends_with_ignoring_case(path, ".xdc")) return "";
  return path + ": edsc reads XDD and XDC files, but does not write them; name the file .eds or .dcf";
}

}  // namespace edsc
