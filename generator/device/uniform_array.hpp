/// Arrays of equal elements.
#pragma once

#include "device/device.hpp"

namespace edsc {

/// An ARRAY whose elements 1..N have the same numeric type, access and limits: one template in C++.
[[nodiscard]] bool describes_uniform_array(const Object& object);

}  // namespace edsc
