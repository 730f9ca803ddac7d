/// Unit and Factor, keys of some vendors: a raw value times Factor is the value in Unit.
#pragma once

#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// Whether raw values are not in Unit: Factor is neither missing nor 1.
[[nodiscard]] bool is_scaled(const Entry& entry);

/// The unit of a raw value; empty for a scaled entry, and without Unit.
[[nodiscard]] std::string_view raw_unit(const Entry& entry);

/// What a raw value of 1 is: `rpm`, or with its Factor `0.1 V`; empty if the EDS does not say it.
[[nodiscard]] std::string physical_unit(const Entry& entry);

}  // namespace edsc
