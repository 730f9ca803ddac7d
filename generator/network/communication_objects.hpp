/// Indices of the communication profile that a network connects (CiA 301, 7.5.2).
#pragma once

#include <canopen/pdo/transmission_type.hpp>
#include <cstdint>

namespace edsc::communication {

inline constexpr std::uint16_t cob_id_sync = 0x1005;
inline constexpr std::uint16_t cycle_period = 0x1006;
inline constexpr std::uint16_t window_length = 0x1007;
inline constexpr std::uint16_t guard_time = 0x100C;
inline constexpr std::uint16_t life_time_factor = 0x100D;
inline constexpr std::uint16_t inhibit_time_emcy = 0x1015;
inline constexpr std::uint16_t consumer_heartbeat = 0x1016;
inline constexpr std::uint16_t producer_heartbeat = 0x1017;
inline constexpr std::uint16_t identity = 0x1018;
inline constexpr std::uint16_t sync_overflow = 0x1019;
inline constexpr std::uint16_t verify_configuration = 0x1020;
inline constexpr std::uint16_t concise_dcf = 0x1F22;
inline constexpr std::uint16_t slave_assignment = 0x1F81;

/// Whether a PDO with this transmission type is sent or applied at a SYNC.
[[nodiscard]] constexpr bool is_synchronous(std::uint64_t transmission_type) {
  const auto transmission = canopen::transmission_of(static_cast<std::uint32_t>(transmission_type));
  return transmission == canopen::Transmission::synchronous ||
         transmission == canopen::Transmission::remote_synchronous;
}

}  // namespace edsc::communication
