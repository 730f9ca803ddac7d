/// The objects that plugged-in modules bring along (CiA 306-1, clause 6).
#pragma once

#include "device/device.hpp"
#include "device/object_resolver.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Adds fixed objects once for each kind of module that is connected, and the sub-indices of each module in the order
/// of their places. The device's objects stay in order.
void add_modules(const Modules& modules, ObjectResolver& objects, EntryResolver& entries, Device& device,
                 Diagnostics& diagnostics);

}  // namespace edsc
