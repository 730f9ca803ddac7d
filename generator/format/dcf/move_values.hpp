/// Converts the configuration of one node to another node.
#pragma once

#include <cstdint>

#include "device/device.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Sets each ParameterValue that is the default value for the node-ID of the DCF, such as CAN-ID 185h of
/// `$NODEID+0x180`, to the value for `node_id`; a COB-ID also if only its flags differ from the default value. `device`
/// is that of `sheet` with the node-ID of the DCF. A COB-ID without a formula remains, and is reported if its CAN-ID is
/// one of the node.
void move_values(Document& document, const DataSheet& sheet, const Device& device, std::uint8_t node_id,
                 Diagnostics& diagnostics);

}  // namespace edsc
