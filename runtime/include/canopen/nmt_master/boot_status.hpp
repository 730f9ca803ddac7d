/// Result of the boot-up of an NMT slave (CiA 302-2, error status of the boot slave process).
#pragma once

#include <cstdint>
#include <string_view>

#include "canopen/base/abort_code.hpp"

namespace canopen {

/// The capital letters are those of CiA 302-2. Those in lower case are faults of the supervised boot-up.
enum class BootStatus : char {
  booted = '0',
  not_listed = 'A',
  no_response = 'B',
  device_type = 'C',
  vendor_id = 'D',
  no_state = 'E',
  no_guarding = 'F',
  software_unknown = 'G',
  software_not_allowed = 'H',
  software_update = 'I',
  configuration = 'J',
  no_heartbeat = 'K',
  was_operational = 'L',
  product_code = 'M',
  revision_number = 'N',
  serial_number = 'O',
  restarted = 'r',
  extra_response = 'x',
  not_as_written = 'w',
  heartbeat_rate = 'h',
  heartbeat_states = 's',
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
    {BootStatus::no_state, "no heartbeat of a node that is not to be reset if it is Operational"},
    {BootStatus::no_guarding, "no answer to guarding when error control was started"},
    {BootStatus::software_unknown, "software 1F56h:01 could not be read, or 1F55h has no value to compare it with"},
    {BootStatus::software_not_allowed, "software 1F56h:01 is not the one of 1F55h, and 1F81h does not allow an update"},
    {BootStatus::software_update, "software 1F56h:01 is not the one of 1F55h; the application has to update it"},
    {BootStatus::configuration, "configuration failed"},
    {BootStatus::no_heartbeat, "no heartbeat when error control was started"},
    {BootStatus::was_operational, "node was Operational already and stays so"},
    {BootStatus::product_code, "product code 1018h:02 is not the one of 1F86h"},
    {BootStatus::revision_number, "revision number 1018h:03 is not the one of 1F87h"},
    {BootStatus::serial_number, "serial number 1018h:04 is not the one of 1F88h"},
    {BootStatus::restarted, "boot-up message during the boot-up: the node restarts, or two nodes have its node-ID"},
    {BootStatus::extra_response,
     "more SDO responses than requests: two nodes have its node-ID, or another SDO client uses it"},
    {BootStatus::not_as_written, "value read back is not the one written"},
    {BootStatus::heartbeat_rate, "heartbeats are not sent at the rate of 1017h"},
    {BootStatus::heartbeat_states, "heartbeats have different states: two nodes may have its node-ID"},
};

/// Whether a status is a fault of the supervised boot-up: the slave is reset and booted again a few times; then it is
/// left in Pre-operational.
[[nodiscard]] constexpr bool is_disturbed(BootStatus status) { return static_cast<char>(status) >= 'a'; }

[[nodiscard]] constexpr std::string_view to_text(BootStatus status) {
  for (const auto& row : boot_status_texts) {
    if (row.status == status) return row.text;
  }
  return "unknown boot status";
}

/// How a boot-up ended, and why. A failure is explained by the entry of the slave that was the last step, and by the
/// abort code or the two values.
struct BootResult {
  BootStatus status = BootStatus::booted;
  AbortCode abort_code = ok;  ///< of the SDO transfer that caused the status, or of the application's configuration
  std::uint16_t index = 0;    ///< entry of that transfer, or of the number that differs; 0: none
  std::uint8_t sub_index = 0;
  /// Identity number or software version in the network list, first bytes of a value in the concise DCF, or heartbeat
  /// time in ms
  std::uint32_t expected = 0;
  std::uint32_t seen = 0;  ///< the one of the node, if `abort_code` is `ok`

  constexpr operator BootStatus() const { return status; }  // NOLINT(google-explicit-constructor): the short form
};

}  // namespace canopen
