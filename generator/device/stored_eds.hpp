/// A device that keeps its data sheet: 1021h and 1022h (CiA 301, 7.5.2.24 and 7.5.2.25).
#pragma once

#include <string>

#include "device/device.hpp"
#include "device/options.hpp"

namespace edsc {

inline constexpr std::uint16_t store_eds = 0x1021;
inline constexpr std::uint16_t store_format = 0x1022;

/// 1022h: how 1021h holds the data sheet.
enum class StoreFormat : std::uint8_t {
  text = 0x00,  ///< ISO 10646, not compressed
  gzip = 0x80,  ///< RFC 1952; the first of the manufacturer's own formats
};

/// Where the options want the data sheet in the device: 1022h tells its format. An error where 1021h is no DOMAIN that
/// is only read, or where a compressed one has no 1022h to tell it by.
void resolve_stored_eds(Device& device, const Options& options, Diagnostics& diagnostics);

/// The bytes of 1021h, in UTF-8; none where the options do not want them.
[[nodiscard]] std::string stored_eds(const Device& device, const Options& options);

}  // namespace edsc
