/// The PDOs of a device as the C++ templates see them.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"

namespace edsc {

/// One row for each PDO that has a mapping parameter: its layout as a type, and what the compiler is told to check.
[[nodiscard]] nlohmann::ordered_json pdo_rows(const Device& device);

/// Whether its COB-ID is not legal: it may be sent on no account.
[[nodiscard]] bool has_wrong_cob_id(const Pdo& pdo);

/// Whether the generated code has no PDO for it: its mapping or its COB-ID is wrong.
[[nodiscard]] bool is_left_out(const Pdo& pdo);

/// Those of pdo_rows() that take part in the check for COB-IDs of their own.
[[nodiscard]] nlohmann::ordered_json distinct_pdos(const Device& device);

}  // namespace edsc
