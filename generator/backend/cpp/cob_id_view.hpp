/// The COB-IDs of a device's services as the C++ templates see them.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"

namespace edsc {

/// One row for each COB-ID of SYNC, TIME, EMCY, SDO servers and SDO clients that is on after a reset: what the compiler
/// is told to check. PDOs have pdo_rows().
[[nodiscard]] nlohmann::ordered_json cob_id_rows(const Device& device);

}  // namespace edsc
