/// Result of the boot-up of an NMT slave (CiA 302-2, error status of the boot slave process).
#pragma once

#include <cstdint>
#include <string_view>

#include "canopen/base/abort_code.hpp"

namespace canopen {

/// The letters are those of CiA 302-2. G, H and I are for program download, which this master does not support.
enum class BootStatus : char {
  booted = '0',
  not_listed = 'A',
  no_response = 'B',
  device_type = 'C',
  vendor_id = 'D',
  no_guarding = 'F',
  configuration = 'J',
  no_heartbeat = 'K',
  was_operational = 'L',
  product_code = 'M',
  revision_number = 'N',
  serial_number = 'O',
};

struct BootStatusText {
  BootStatus status;
  std::string_view text;
};

inline constexpr BootStatusText boot_status_texts[] = {
    {BootStatus::booted, "booted"},
    {BootStatus::not_listed, "node is not in the network list 1F81h"},
    {BootStatus::no_response, "no answer, or device type 1000h could not be read"},
    {BootStatus::device_type, "device type 1000h is not the one of 1F84h"},
    {BootStatus::vendor_id, "vendor-ID 1018h:01 is not the one of 1F85h"},
    {BootStatus::no_guarding, "no answer to guarding when error control was started"},
    {BootStatus::configuration, "configuration failed"},
    {BootStatus::no_heartbeat, "no heartbeat when error control was started"},
    {BootStatus::was_operational, "node was Operational already and stays so"},
    {BootStatus::product_code, "product code 1018h:02 is not the one of 1F86h"},
    {BootStatus::revision_number, "revision number 1018h:03 is not the one of 1F87h"},
    {BootStatus::serial_number, "serial number 1018h:04 is not the one of 1F88h"},
};

[[nodiscard]] constexpr std::string_view to_text(BootStatus status) {
  for (const auto& row : boot_status_texts) {
    if (row.status == status) return row.text;
  }
  return "unknown boot status";
}

/// How a boot-up ended, and why.
struct BootResult {
  BootStatus status = BootStatus::booted;
  AbortCode abort_code = ok;  ///< of the SDO transfer that caused the status, or of the application's configuration
  std::uint16_t index = 0;    ///< entry of that transfer, or of the identity number that differs; 0: none
  std::uint8_t sub_index = 0;
  std::uint32_t expected = 0;  ///< identity number in the network list
  std::uint32_t seen = 0;      ///< identity number of the node, if `abort_code` is `ok`

  constexpr operator BootStatus() const { return status; }  // NOLINT(google-explicit-constructor): the short form
};

}  // namespace canopen
