/// An EDS becomes the DCF of one node: CiA 306-1, clause 5.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Gives a document in canonical form its [DeviceComissioning], and each writable entry the ParameterValue that its default
/// gives for the node-ID of `device`. The ParameterValues of an EDS, which have no meaning there, are dropped; those of a
/// DCF stay, their formulas resolved.
void make_dcf(Document& document, const DataSheet& sheet, const Device& device);

}  // namespace edsc
