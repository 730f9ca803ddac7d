/// The objects of CiA 301 that the conformance test names.
#pragma once

#include <cstdint>

namespace edsc::conform {

inline constexpr std::uint16_t device_type = 0x1000;
inline constexpr std::uint16_t error_register = 0x1001;
inline constexpr std::uint16_t status_register = 0x1002;
inline constexpr std::uint16_t error_history = 0x1003;
inline constexpr std::uint16_t sync_cob_id = 0x1005;
inline constexpr std::uint16_t sync_period = 0x1006;
inline constexpr std::uint16_t sync_window = 0x1007;
inline constexpr std::uint16_t guard_time = 0x100C;
inline constexpr std::uint16_t life_time_factor = 0x100D;
inline constexpr std::uint16_t store_parameters = 0x1010;
inline constexpr std::uint16_t restore_parameters = 0x1011;
inline constexpr std::uint16_t high_resolution_time = 0x1013;
inline constexpr std::uint16_t emcy = 0x1014;
inline constexpr std::uint16_t consumer_heartbeat = 0x1016;
inline constexpr std::uint16_t producer_heartbeat = 0x1017;
inline constexpr std::uint16_t identity = 0x1018;
inline constexpr std::uint16_t sync_overflow = 0x1019;
inline constexpr std::uint16_t verify_configuration = 0x1020;
inline constexpr std::uint16_t emergency_consumer = 0x1028;
inline constexpr std::uint16_t error_behavior = 0x1029;
inline constexpr std::uint16_t default_sdo_server = 0x1200;
inline constexpr std::uint16_t nmt_startup = 0x1F80;

}  // namespace edsc::conform
