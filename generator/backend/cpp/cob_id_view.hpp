/// The COB-IDs of a device's services for the C++ templates.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"

namespace edsc {

/// One row for each COB-ID of SYNC, TIME, EMCY, SDO servers and SDO clients that is enabled after a reset, for the
/// checks of the C++ compiler. PDOs have pdo_rows().
[[nodiscard]] nlohmann::ordered_json cob_id_rows(const Device& device);

}  // namespace edsc
