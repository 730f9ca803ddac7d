/// Units and scales that other objects of the device state: SI units and feed constant of drives, SI unit and decimal
/// digits of measuring devices.
#pragma once

#include <cstdint>
#include <optional>

#include "device/device.hpp"

namespace edsc {

/// The quantity of a number of CiA 303-2: bits 31..24 the exponent of ten, 23..16 the numerator, 15..8 the denominator
/// of the unit. Nothing for a unit that edsc does not know.
[[nodiscard]] std::optional<Quantity> quantity_of_si_unit(std::uint32_t number);

/// Gives entries of profiles 402 and 404 the quantity that the default values of these objects state. Only entries
/// that have neither options, keys of the EDS nor a quantity of the profile.
void resolve_profile_scales(Device& device);

}  // namespace edsc
