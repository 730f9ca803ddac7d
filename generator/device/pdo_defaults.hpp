/// What a PDO's parameters say after a reset.
#pragma once

#include <cstdint>
#include <optional>

#include "device/device.hpp"
#include "device/options.hpp"

namespace edsc {

/// Where a communication parameter holds the transmission type (CiA 301, 7.5.2.35).
inline constexpr std::uint8_t transmission_type_sub_index = 2;

/// Whether the PDO is valid after a reset: bit 31 of its COB-ID is 0.
[[nodiscard]] bool on_by_default(const Pdo& pdo);

/// The default of a sub-index of the communication parameter; nothing when there is none.
[[nodiscard]] std::optional<std::uint64_t> communication_default(const Pdo& pdo, std::uint8_t sub_index);

/// Bytes that a VISIBLE_STRING or OCTET_STRING may take in a PDO: what its options say that it holds, else the length of
/// its DEFTYPE or of its default. Nothing where none is known.
[[nodiscard]] std::optional<std::uint32_t> mapped_string_capacity(const Entry& entry, const Options& options);

}  // namespace edsc
