/// CANopenObjectList: the objects, with the properties of their parameters.
#pragma once

#include <vector>

#include "eds/data_sheet.hpp"
#include "xdd/application_process.hpp"
#include "xdd/xml_document.hpp"

namespace edsc {

/// Ascending by index, each index once.
[[nodiscard]] std::vector<ObjectDescription> read_object_list(XmlDocument& xml, pugi::xml_node list,
                                                              ApplicationProcess& process);

/// The positions of the objects and their sub-objects.
[[nodiscard]] SheetOutline outline_of(const XmlDocument& xml, pugi::xml_node list);

}  // namespace edsc
