/// CAN-IDs and COB-IDs: the pre-defined connection set, the flag bits, and the identifiers that may not be configured.
#pragma once

#include <cstdint>

#include "canopen/node_id.hpp"

namespace canopen {

/// Function codes of the pre-defined connection set (CiA 301, 7.3.5): add the node-ID where there is one.
namespace function_code {
inline constexpr std::uint16_t nmt = 0x000;
inline constexpr std::uint16_t sync = 0x080;
inline constexpr std::uint16_t emcy = 0x080;
inline constexpr std::uint16_t time = 0x100;
inline constexpr std::uint16_t tpdo1 = 0x180;
inline constexpr std::uint16_t rpdo1 = 0x200;
inline constexpr std::uint16_t tpdo2 = 0x280;
inline constexpr std::uint16_t rpdo2 = 0x300;
inline constexpr std::uint16_t tpdo3 = 0x380;
inline constexpr std::uint16_t rpdo3 = 0x400;
inline constexpr std::uint16_t tpdo4 = 0x480;
inline constexpr std::uint16_t rpdo4 = 0x500;
inline constexpr std::uint16_t sdo_response = 0x580;  ///< server to client
inline constexpr std::uint16_t sdo_request = 0x600;   ///< client to server
inline constexpr std::uint16_t error_control = 0x700;
}  // namespace function_code

/// A COB-ID as the communication parameters hold it: a CAN-ID and three flags (CiA 301, 7.5.2.x).
class CobId {
 public:
  static constexpr std::uint32_t invalid_bit = 0x8000'0000;  ///< PDO, SDO, EMCY: does not exist
  static constexpr std::uint32_t no_rtr_bit = 0x4000'0000;   ///< TPDO: no remote frame; SYNC: this device produces it
  static constexpr std::uint32_t extended_bit = 0x2000'0000; ///< 29-bit identifier

  constexpr CobId() = default;
  constexpr explicit CobId(std::uint32_t value) : value_{value} {}

  [[nodiscard]] constexpr std::uint32_t value() const { return value_; }
  [[nodiscard]] constexpr bool valid() const { return (value_ & invalid_bit) == 0; }
  [[nodiscard]] constexpr bool rtr_allowed() const { return (value_ & no_rtr_bit) == 0; }
  [[nodiscard]] constexpr bool extended() const { return (value_ & extended_bit) != 0; }
  [[nodiscard]] constexpr std::uint32_t can_id() const { return value_ & (extended() ? 0x1FFF'FFFFu : 0x7FFu); }

  friend constexpr bool operator==(CobId, CobId) = default;

 private:
  std::uint32_t value_ = invalid_bit;
};

/// A range of CAN-IDs that no configurable object may use, with the reason (CiA 301, 7.3.5, table 41).
struct RestrictedCanIds {
  std::uint16_t first;
  std::uint16_t last;
  const char* reason;
};

inline constexpr RestrictedCanIds restricted_can_ids[] = {
    {0x000, 0x000, "NMT"},
    {0x001, 0x07F, "reserved"},
    {0x101, 0x180, "reserved"},
    {0x581, 0x5FF, "default SDO, server to client"},
    {0x601, 0x67F, "default SDO, client to server"},
    {0x6E0, 0x6FF, "reserved"},
    {0x701, 0x77F, "NMT error control"},
    {0x780, 0x7FF, "reserved"},
};

/// Why an 11-bit CAN-ID may not be used by a configurable object; null when it may.
[[nodiscard]] constexpr const char* restriction_of(std::uint32_t can_id) {
  for (const auto& range : restricted_can_ids) {
    if (can_id >= range.first && can_id <= range.last) return range.reason;
  }
  return nullptr;
}

}  // namespace canopen
