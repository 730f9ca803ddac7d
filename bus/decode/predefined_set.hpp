/// The CAN-IDs of the pre-defined connection set (CiA 301, 7.3.5): a function code and a node-ID.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <optional>

namespace edsc {

[[nodiscard]] constexpr std::uint32_t function_code_of(std::uint32_t can_id) { return can_id & 0x780; }
/// 0: NMT, SYNC, TIME.
[[nodiscard]] constexpr std::uint8_t node_id_of(std::uint32_t can_id) {
  return static_cast<std::uint8_t>(can_id & 0x7F);
}

struct PredefinedPdo {
  std::uint8_t node_id;
  bool transmit;
  std::uint16_t number;  ///< 1..4
};

/// The PDO with this CAN-ID of 11 bits; nothing for those of other services.
[[nodiscard]] constexpr std::optional<PredefinedPdo> predefined_pdo(std::uint32_t can_id) {
  namespace code = canopen::function_code;
  if (can_id < code::tpdo1 || can_id >= code::sdo_response || node_id_of(can_id) == 0) return std::nullopt;
  const bool transmit = (can_id & 0x80) != 0;
  const std::uint32_t first = transmit ? code::tpdo1 : code::rpdo1;
  const auto number = static_cast<std::uint16_t>((function_code_of(can_id) - first) / 0x100 + 1);
  return PredefinedPdo{node_id_of(can_id), transmit, number};
}

}  // namespace edsc
