/// The CAN-IDs that the nodes of a network use: who transmits what, and who receives it.
#pragma once

#include <canopen/can/cob_id.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "device/cob_id_parameter.hpp"
#include "network/network.hpp"

namespace edsc {

enum class FrameService : std::uint8_t { nmt, sync, time, emcy, sdo, pdo, error_control };

/// The frames that a CAN-ID of an SDO carries.
enum class SdoFrames : std::uint8_t { none, requests, responses };

/// A CAN-ID that a node transmits or receives.
struct CobIdUse {
  const NetworkNode* node = nullptr;
  FrameService service = FrameService::pdo;
  SdoFrames sdo = SdoFrames::none;
  bool transmits = false;
  std::uint32_t can_id = 0;
  bool extended = false;
  bool is_configurable = true;  ///< an object contains it
  const Pdo* pdo = nullptr;
  std::string what;   ///< `TPDO 2`, `SDO server 1 response`
  Position position;  ///< of the value, or of the node
};

/// A CAN-ID as a COB-ID has it: with bit 29 for one of 29 bits.
[[nodiscard]] constexpr std::uint32_t cob_id_of(std::uint32_t can_id, bool extended) {
  return can_id | (extended ? canopen::CobId::extended_bit : 0U);
}

/// The uses of all nodes: configured COB-IDs that exist, and the fixed ones of NMT, the default SDO and error control.
[[nodiscard]] std::vector<CobIdUse> cob_id_uses(const Network& network);

/// The first node that transmits SYNC; null if none does.
[[nodiscard]] const CobIdUse* sync_producer(const std::vector<CobIdUse>& uses);

/// `185h`, or `1234h (29 bits)`.
[[nodiscard]] std::string can_id_text(std::uint32_t can_id, bool extended);

/// `axis1 TPDO 2`
[[nodiscard]] std::string named(const CobIdUse& use);

}  // namespace edsc
