/// Compares the identity of a device on the bus with an EDS.
#pragma once

#include <canopen/lss/lss_protocol.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

class SdoAccess;

/// The identity of a device; nothing for unknown numbers.
struct Identity {
  std::optional<std::uint32_t> device_type, vendor_id, product_code, revision_number, serial_number;
};

/// The identity in an EDS: 1000h and 1018h, else [DeviceInfo]; the serial number is LSS_SerialNumber of a DCF. The
/// number 0 means unknown.
[[nodiscard]] Identity identity_of(const Device& device);

enum class IdentityMatch : std::uint8_t {
  same,            ///< all numbers that both state are equal
  minor_revision,  ///< except for the minor revision: the CANopen behaviour is the same
  major_revision,  ///< except for the revision number
  other,           ///< another device type, vendor, product or serial number
  unknown,         ///< no number that both state
};

/// `same device`
[[nodiscard]] std::string_view to_text(IdentityMatch match);

/// Reads device type and identity object.
[[nodiscard]] Identity read_identity(SdoAccess& node);

/// Compares the numbers that both state.
[[nodiscard]] IdentityMatch compare_identity(const Identity& sheet, const Identity& device);

/// The differences, number by number: `product code is 00001234h, expected 00001235h`.
[[nodiscard]] std::string identity_differences(const Identity& sheet, const Identity& device);

/// The number of differences.
[[nodiscard]] unsigned count_differences(const Identity& sheet, const Identity& device);

/// A number that could not be compared.
struct NotCompared {
  std::string_view name;  ///< `vendor-ID`
  std::string_view key;   ///< in JSON: `vendor_id`
  bool in_sheet = false;  ///< stated by the EDS, but not by the device
};

/// The numbers among device type, vendor-ID, product code and revision number that one of them does not state; the
/// serial number only if the EDS states it.
[[nodiscard]] std::vector<NotCompared> not_compared(const Identity& sheet, const Identity& device);

/// `vendor-ID, product code`
[[nodiscard]] std::string names_of(const std::vector<NotCompared>& numbers);

}  // namespace edsc
