/// A device that stores its EDS: 1021h and 1022h (CiA 301, 7.5.2.24 and 7.5.2.25).
#pragma once

#include <string>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

inline constexpr std::uint16_t store_eds = 0x1021;
inline constexpr std::uint16_t store_format = 0x1022;

/// 1022h: the format of the EDS in 1021h.
enum class StoreFormat : std::uint8_t {
  text = 0x00,  ///< ISO 10646, not compressed
  gzip = 0x80,  ///< RFC 1952; the first manufacturer-specific format
};

/// If the options request a stored EDS, sets 1022h to its format. Reports an error if 1021h is not a read-only DOMAIN,
/// or if a compressed EDS has no 1022h.
void resolve_stored_eds(Device& device, const Options& options, Diagnostics& diagnostics);

/// The bytes of 1021h, in UTF-8; empty unless the options request them.
[[nodiscard]] std::string stored_eds(const Device& device, const Options& options);

}  // namespace edsc
