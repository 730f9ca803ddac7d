/// One entry of the object dictionary in two versions of a device.
#pragma once

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

/// Compares type, access, mapping, limits and default value. `in_rpdo`: an RPDO maps the entry by default, so that its
/// limits apply to the sender too. The default values of PDO communication and mapping parameters are compared as PDOs.
void compare_entries(const Entry& before, const Entry& after, bool in_rpdo, Changes& changes);

/// A value in EDS spelling; strings in quotes; `none` if missing.
[[nodiscard]] std::string value_text(const std::optional<Value>& value, const canopen::DataTypeRow& type);

[[nodiscard]] bool same_value(const std::optional<Value>& a, const std::optional<Value>& b);

}  // namespace edsc
