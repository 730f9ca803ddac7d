/// The configuration of one node becomes that of another.
#pragma once

#include <cstdint>

#include "device/device.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// Gives each ParameterValue that is the default of the DCF's own node, such as CAN-ID 185h of `$NODEID+0x180`, the value
/// for `node_id`; of a COB-ID also where only its flags differ from the default. `device` is that of `sheet` with the
/// DCF's own node-ID. A COB-ID without a formula that has a CAN-ID of the own node stays, and is reported.
void move_values(Document& document, const DataSheet& sheet, const Device& device, std::uint8_t node_id,
                 Diagnostics& diagnostics);

}  // namespace edsc
