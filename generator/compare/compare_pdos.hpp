/// The default PDOs in two versions of a device.
#pragma once

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

void compare_pdos(const Device& before, const Device& after, Changes& changes);

/// Whether the object holds the communication or mapping parameter of a PDO (1400h..1BFFh).
[[nodiscard]] bool is_pdo_parameter(std::uint16_t index);

}  // namespace edsc
