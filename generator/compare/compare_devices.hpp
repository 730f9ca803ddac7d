/// Compares two versions of a device by meaning.
#pragma once

#include "backend/cpp/cpp_names.hpp"
#include "compare/change.hpp"

namespace edsc {

/// Compares device data, then objects and entries ascending, then PDOs.
[[nodiscard]] Changes compare_devices(const NamedDevice& before, const NamedDevice& after);

}  // namespace edsc
