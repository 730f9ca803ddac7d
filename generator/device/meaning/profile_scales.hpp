/// Units and scales that other objects of the device state: SI units, feed constant, encoder resolution and gear ratio
/// of drives, physical unit and decimal digits of measuring devices.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "device/device.hpp"

namespace edsc {

/// The quantity of a number of CiA 303-2: bits 31..24 the exponent of ten, 23..16 the numerator, 15..8 the denominator
/// of the unit. Nothing for a unit that edsc does not know.
[[nodiscard]] std::optional<Quantity> quantity_of_si_unit(std::uint32_t number);

/// The number in an entry of the device; nothing if it is unknown.
using NumberOfEntry = std::function<std::optional<std::uint64_t>(const Entry&)>;

/// Whether entries that can change state the unit and scale of this one, or could: the profile assigns it the units of
/// such objects, and neither the options, the EDS nor constant entries state a quantity.
[[nodiscard]] bool has_profile_scale(const Device& device, const Entry& entry);

/// The quantity of such an entry by the numbers of the entries that state it; nothing if they do not state one.
[[nodiscard]] std::optional<Quantity> profile_scale(const Device& device, const Entry& entry,
                                                    const NumberOfEntry& number_of);

/// Gives entries of profiles 402 and 404 the quantity that the default values of these objects state, again after a
/// change of default values. Only entries that have neither options, keys of the EDS nor a quantity of the profile.
void resolve_profile_scales(Device& device);

}  // namespace edsc
