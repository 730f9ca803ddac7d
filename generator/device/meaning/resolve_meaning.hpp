/// The meaning of each entry of a device.
#pragma once

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The quantity that Unit, Factor and Offset of a section state; nothing without one of them. A Factor or Offset that
/// is not a number is reported, and the unit is then that of a raw value times an unknown factor: nothing is converted.
[[nodiscard]] std::optional<Quantity> quantity_of_keys(const EntryDescription& description, Diagnostics& diagnostics);

/// The names of values that an XDD states, as in C++: `Velocity control` is velocity_control. The first one of a number
/// or name is used; a number outside the type is reported. Nothing for a type that is not an integer.
[[nodiscard]] std::optional<Enumeration> names_of_values(const EntryDescription& description,
                                                         const canopen::DataTypeRow& type, Diagnostics& diagnostics);

/// Gives each entry its meaning: from the options, the keys of the EDS, and the profiles of the device, in this order.
/// Reports options that name objects which the device does not have, and options that contradict the EDS.
void resolve_meaning(Device& device, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
