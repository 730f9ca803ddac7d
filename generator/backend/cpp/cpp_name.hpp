/// The names of entries in the generated headers.
#pragma once

#include <string>

#include "device/device.hpp"

namespace edsc {

/// The type of an entry in the namespace of its device: `od::statusword`, `od::gains<1>` for an ARRAY of equal
/// elements, `od::identity::vendor_id`. The identifiers of object and entry are set.
[[nodiscard]] std::string cpp_name(const Object& object, const Entry& entry);

}  // namespace edsc
