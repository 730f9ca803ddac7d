/// The PDOs of a device for the C++ templates.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"

namespace edsc {

/// One row for each PDO that has a mapping parameter: its layout as a type, and the checks of the C++ compiler.
[[nodiscard]] nlohmann::ordered_json pdo_rows(const Device& device);

/// Whether the COB-ID of the PDO is invalid, so that it must not be sent.
[[nodiscard]] bool has_wrong_cob_id(const Pdo& pdo);

/// Whether the PDO is not generated, since its mapping or its COB-ID is invalid.
[[nodiscard]] bool is_left_out(const Pdo& pdo);

/// The rows of pdo_rows() for the check for distinct COB-IDs.
[[nodiscard]] nlohmann::ordered_json distinct_pdos(const Device& device);

}  // namespace edsc
