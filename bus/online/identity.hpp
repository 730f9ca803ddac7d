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

enum class IdentityMatch : std::uint8_t {
  same,            ///< all numbers that both state are equal
  minor_revision,  ///< except for the minor revision: the CANopen behaviour is the same
  major_revision,  ///< except for the revision number
  other,           ///< another device type, vendor, product or serial number
  unknown,         ///< no number that both state
};

/// One of the numbers, and the object that has it.
struct IdentityNumber {
  std::string_view name;  ///< `vendor-ID`
  std::string_view key;   ///< in JSON: `vendor_id`
  std::uint16_t index;
  std::uint8_t sub_index;
  std::optional<std::uint32_t> Identity::*value;
  IdentityMatch difference;  ///< of two devices that differ in it
  bool usual = true;         ///< every EDS should state it
};

inline constexpr IdentityNumber identity_numbers[] = {
    {"device type", "device_type", 0x1000, 0, &Identity::device_type, IdentityMatch::other},
    {"vendor-ID", "vendor_id", 0x1018, 1, &Identity::vendor_id, IdentityMatch::other},
    {"product code", "product_code", 0x1018, 2, &Identity::product_code, IdentityMatch::other},
    {"revision number", "revision_number", 0x1018, 3, &Identity::revision_number, IdentityMatch::major_revision},
    {"serial number", "serial_number", 0x1018, 4, &Identity::serial_number, IdentityMatch::other, false},
};

/// The identity in an EDS: 1000h and 1018h, else [DeviceInfo]; the serial number is LSS_SerialNumber of a DCF. The
/// number 0 means unknown.
[[nodiscard]] Identity identity_of(const Device& device);

/// Whether at least one number is known.
[[nodiscard]] bool has_numbers(const Identity& identity);

/// Whether the EDS describes the device, at least in another revision.
[[nodiscard]] bool fits(IdentityMatch match);

/// `same device`
[[nodiscard]] std::string_view to_text(IdentityMatch match);

/// What a node says about itself.
struct ReadIdentity {
  Identity identity;  ///< without the numbers that the node refuses
  const IdentityNumber* unanswered =
      nullptr;  ///< the number that the node did not answer; those after it were not read
};

/// Reads device type and identity object.
[[nodiscard]] ReadIdentity read_identity(SdoAccess& node);

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
