/// CANopenObjectList: the objects, and what their parameters say of them.
#pragma once

#include <vector>

#include "eds/data_sheet.hpp"
#include "xdd/application_process.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// Ascending by index, each index once.
[[nodiscard]] std::vector<ObjectDescription> read_object_list(XmlDocument& xml, pugi::xml_node list,
                                                              ApplicationProcess& process);

/// Where the objects and their sub-objects are.
[[nodiscard]] SheetOutline outline_of(const XmlDocument& xml, pugi::xml_node list);

}  // namespace edsc
