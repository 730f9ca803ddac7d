/// How the boot-up of an NMT slave ended (CiA 302-2, error status of the boot slave process).
#pragma once

#include <cstdint>
#include <string_view>

namespace canopen {

/// The letters are those of CiA 302-2. G, H and I are of program download, J of configuration: not of this master.
enum class BootStatus : char {
  booted = '0',
  not_listed = 'A',
  no_response = 'B',
  device_type = 'C',
  vendor_id = 'D',
  no_guarding = 'F',
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
    {BootStatus::no_response, "device type 1000h could not be read"},
    {BootStatus::device_type, "device type 1000h is not the one of 1F84h"},
    {BootStatus::vendor_id, "vendor-ID 1018h:01 is not the one of 1F85h"},
    {BootStatus::no_guarding, "no answer to guarding when error control was started"},
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

}  // namespace canopen
