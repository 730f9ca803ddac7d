/// The numbers of a slave that an NMT master compares with its network list (CiA 302-2): the identity with 1F84h to
/// 1F88h, the date and time of the configuration with 1F26h and 1F27h.
#pragma once

#include <cstdint>

#include "canopen/nmt_master/boot_status.hpp"
#include "canopen/nmt_master/network_list.hpp"

namespace canopen {

/// One number of a slave's identity: the entry to read, the expected value, and the boot status if it differs.
struct IdentityCheck {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t NmtSlave::*expected;
  BootStatus failure;
};

/// In the order of the boot-up process. The first one is always read, to check whether the node responds.
inline constexpr IdentityCheck identity_checks[] = {
    {0x1000, 0, &NmtSlave::device_type, BootStatus::device_type},
    {0x1018, 1, &NmtSlave::vendor_id, BootStatus::vendor_id},
    {0x1018, 2, &NmtSlave::product_code, BootStatus::product_code},
    {0x1018, 3, &NmtSlave::revision_number, BootStatus::revision_number},
    {0x1018, 4, &NmtSlave::serial_number, BootStatus::serial_number},
};

/// One number of 1020h: its sub-index, and the expected value.
struct ConfigurationCheck {
  std::uint8_t sub_index;
  std::uint32_t NmtSlave::*expected;
};

/// If both are equal, the slave has its configuration already.
inline constexpr ConfigurationCheck configuration_checks[] = {
    {1, &NmtSlave::configuration_date},
    {2, &NmtSlave::configuration_time},
};

}  // namespace canopen
