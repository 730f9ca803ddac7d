/// Whether a device on the bus is the one of a data sheet.
#pragma once

#include <canopen/lss_protocol.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// Who a device is. Nothing where that is not known.
struct Identity {
  std::optional<std::uint32_t> device_type, vendor_id, product_code, revision_number, serial_number;
};

/// What a data sheet says: 1000h and 1018h, else [DeviceInfo]; the serial number is LSS_SerialNumber of a DCF. A number
/// that is 0 says nothing.
[[nodiscard]] Identity identity_of(const Device& device);

enum class Fit : std::uint8_t {
  same,            ///< all that both know is equal
  minor_revision,  ///< but for the lower half of the revision number: the CANopen behaviour is the same
  major_revision,  ///< but for the revision number
  other,           ///< another device type, vendor, product or serial number
  unknown,         ///< the data sheet, or the device, does not say who it is
};

/// `same device`
[[nodiscard]] std::string_view to_text(Fit fit);

[[nodiscard]] Fit compare_identity(const Identity& sheet, const Identity& device);

/// What differs, number by number: `product code is 00001234h, not 00001235h`.
[[nodiscard]] std::string identity_differences(const Identity& sheet, const Identity& device);

}  // namespace edsc
