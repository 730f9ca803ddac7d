/// Default values of PDO parameters.
#pragma once

#include <cstdint>
#include <optional>

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "pdo/mapping_fault.hpp"

namespace edsc {

/// Sub-indices of a communication parameter (CiA 301, 7.5.2.35 and 7.5.2.37).
inline constexpr std::uint8_t transmission_type_sub_index = 2;
inline constexpr std::uint8_t inhibit_time_sub_index = 3;  ///< in multiples of 100 us
inline constexpr std::uint8_t event_timer_sub_index = 5;   ///< in ms

/// Whether the PDO is valid after a reset: bit 31 of its COB-ID is 0.
[[nodiscard]] bool on_by_default(const Pdo& pdo);

/// The default value of a sub-index of the communication parameter, if any.
[[nodiscard]] std::optional<std::uint64_t> communication_default(const Pdo& pdo, std::uint8_t sub_index);

/// Maximum bytes of a VISIBLE_STRING or OCTET_STRING in a PDO: its capacity in the options, else the length of its
/// DEFTYPE or of its default value. Nothing if unknown.
[[nodiscard]] std::optional<std::uint32_t> mapped_string_capacity(const Entry& entry, const Options& options);

/// What a mapping needs to know of an entry.
[[nodiscard]] MappableObject mappable_object(const Entry& entry, const Options& options);

}  // namespace edsc
