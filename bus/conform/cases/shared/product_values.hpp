/// Which values of a device are constants of the product, so that a difference from their DefaultValue is real.
#pragma once

#include "conform/dut/dut.hpp"

namespace edsc::conform {

/// Whether the value is a constant of the product: access const, or read-only and the same in each device of the
/// product, or the highest sub-index. A correct device may have other values that differ from their default: measured
/// values, counters, and values that a user has written or stored. Other cases test the default values after "load".
[[nodiscard]] bool is_product_value(const Device& sheet, const LiveEntry& entry);

/// Entries that may not have a value now: unused entries of the error history (CiA 301, 7.5.2.4), a string or DOMAIN
/// that was not yet written.
[[nodiscard]] bool may_have_no_value(const LiveEntry& entry);

/// Removes fill characters: devices fill a VISIBLE_STRING with 00h or spaces, and EDS files may lose spaces at its end.
[[nodiscard]] Bytes trimmed(const LiveEntry& entry, Bytes bytes);

}  // namespace edsc::conform
