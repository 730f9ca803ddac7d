/// The errors that services of a node detect, and their emergency error codes.
#pragma once

#include <cstdint>

#include "canopen/emcy/error_register.hpp"

namespace canopen {

/// Errors that services detect. All of them are communication errors.
enum class ServiceError : std::uint8_t {
  pdo_length,
  rpdo_timeout,
  sync_length,
  mpdo_destination,
  error_control,
  overrun,
  bus_passive,
  bus_off,
};

inline constexpr std::uint16_t service_error_codes[] = {
    emergency_code::pdo_length,       emergency_code::rpdo_timeout,  emergency_code::sync_length,
    emergency_code::mpdo_destination, emergency_code::error_control, emergency_code::overrun,
    emergency_code::bus_passive,      emergency_code::bus_off,
};

/// A set of such errors, one bit for each.
using ServiceErrors = std::uint8_t;

[[nodiscard]] constexpr ServiceErrors set_of(ServiceError error) {
  return static_cast<ServiceErrors>(1u << static_cast<std::uint8_t>(error));
}

}  // namespace canopen
