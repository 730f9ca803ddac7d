/// Mappings of PDOs that cannot be changed.
#pragma once

#include "device/device.hpp"

namespace edsc {

/// Whether an entry is a mapped object of a PDO whose number of objects, sub-index 0, cannot be written: a mapping is
/// only changed after that was set to 0 (CiA 301, 7.5.2.36).
[[nodiscard]] bool is_of_fixed_mapping(const Device& device, const Entry& entry);

}  // namespace edsc
