/// The objects of connected modules (CiA 306-1, clause 6).
#pragma once

#include "device/device.hpp"
#include "device/objects/object_resolver.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// Adds the fixed objects of each kind of connected module once, and the sub-indices of each module in the order of
/// their places. The objects of the device remain sorted.
void add_modules(const Modules& modules, ObjectResolver& objects, EntryResolver& entries, Device& device,
                 Diagnostics& diagnostics);

}  // namespace edsc
