/// One entry of the object dictionary in two versions of a device.
#pragma once

#include "compare/change.hpp"
#include "device/device.hpp"

namespace edsc {

/// Type, access, mapping, limits and default. `in_rpdo`: an RPDO carries it by default, so that its sender is bound by
/// its limits, too. Communication and mapping parameters of PDOs are compared as PDOs: their defaults are not looked
/// at.
void compare_entries(const Entry& before, const Entry& after, bool in_rpdo, Changes& changes);

/// A value as a data sheet spells it; strings in quotes; `none` where there is none.
[[nodiscard]] std::string value_text(const std::optional<Value>& value, const canopen::DataTypeRow& type);

[[nodiscard]] bool same_value(const std::optional<Value>& a, const std::optional<Value>& b);

}  // namespace edsc
