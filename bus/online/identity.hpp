/// Whether a device on the bus is the one of a data sheet.
#pragma once

#include <canopen/lss_protocol.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/device.hpp"

namespace edsc {

class SdoAccess;

/// Who a device is. Nothing where that is not known.
struct Identity {
  std::optional<std::uint32_t> device_type, vendor_id, product_code, revision_number, serial_number;
};

/// What a data sheet says: 1000h and 1018h, else [DeviceInfo]; the serial number is LSS_SerialNumber of a DCF. A number
/// that is 0 says nothing.
[[nodiscard]] Identity identity_of(const Device& device);

enum class Fit : std::uint8_t {
  same,            ///< every number that both state is equal
  minor_revision,  ///< except the lower half of the revision number: the CANopen behaviour is the same
  major_revision,  ///< except the revision number
  other,           ///< another device type, vendor, product or serial number
  unknown,         ///< no number is stated by both
};

/// `same device`
[[nodiscard]] std::string_view to_text(Fit fit);

/// Reads device type and identity object.
[[nodiscard]] Identity read_identity(SdoAccess& node);

/// Compares each number that both state; a number that only one of them states does not count.
[[nodiscard]] Fit compare_identity(const Identity& sheet, const Identity& device);

/// The differences, number by number: `product code is 00001234h, expected 00001235h`.
[[nodiscard]] std::string identity_differences(const Identity& sheet, const Identity& device);

/// How many numbers differ.
[[nodiscard]] unsigned count_differences(const Identity& sheet, const Identity& device);

/// A number that could not be compared.
struct NotCompared {
  std::string_view name;  ///< `vendor-ID`
  std::string_view key;   ///< in JSON: `vendor_id`
  bool in_sheet = false;  ///< stated by the sheet, but not by the device
};

/// Device type, vendor-ID, product code and revision number that one of them does not state; the serial number only
/// where the sheet states it.
[[nodiscard]] std::vector<NotCompared> not_compared(const Identity& sheet, const Identity& device);

/// `vendor-ID, product code`
[[nodiscard]] std::string names_of(const std::vector<NotCompared>& numbers);

}  // namespace edsc
