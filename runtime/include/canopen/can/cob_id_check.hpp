/// Compile-time checks of the COB-IDs of SYNC, TIME, EMCY and SDO that a device starts with. For PDOs, see
/// pdo/pdo_check.hpp.
///
///     static_assert(canopen::checked_cob_ids<canopen::StartCobId{0x1014, 0x00, 0x80, true}>());
///
/// The compiler's message names the object and the CAN-ID.
#pragma once

#include <cstdint>

#include "canopen/base/label.hpp"
#include "canopen/can/cob_id.hpp"
#include "canopen/can/node_id.hpp"

namespace canopen {

/// Value of a COB-ID entry after a reset.
struct StartCobId {
  std::uint16_t index;
  std::uint8_t sub_index;
  std::uint32_t cob_id;       ///< without the node-ID if that is added
  bool plus_node_id = false;  ///< the node-ID is added to the COB-ID
};

/// Whether the service with its COB-ID at `index` may not use an 11-bit CAN-ID. An SDO client uses the default SDO of
/// other nodes; an EMCY with the CAN-ID of SYNC would be a SYNC for all others.
[[nodiscard]] constexpr bool is_restricted_for(std::uint16_t index, std::uint32_t can_id) {
  constexpr std::uint32_t node_id = 0x7F;
  const std::uint32_t code = can_id & ~node_id;
  const bool default_sdo = code == function_code::sdo_request || code == function_code::sdo_response;
  if (index >= 0x1280 && index <= 0x12FF && default_sdo && (can_id & node_id) != 0) return false;
  if (index == 0x1014 && can_id == function_code::sync) return true;
  return is_restricted(can_id);
}

/// Whether a device may start with a COB-ID: it has 11 bits, or 29 with bit 29 set, and the service may use its CAN-ID
/// for every node-ID. The default SDO has that of its node (CiA 301, 7.3.5 and 7.5.2.33). An invalid COB-ID may have
/// any value.
[[nodiscard]] constexpr bool is_legal(const StartCobId& start) {
  constexpr std::uint32_t last_node_id = 127;
  const bool has_valid_bit = start.index != 0x1005 && start.index != 0x1012;
  const CobId cob_id{start.cob_id};
  if (start.index == 0x1200) {
    const std::uint32_t base = start.sub_index == 1 ? function_code::sdo_request : function_code::sdo_response;
    return start.plus_node_id ? start.cob_id == base : start.cob_id - base - 1 < last_node_id;
  }
  if ((has_valid_bit && !cob_id.valid()) || cob_id.extended()) return true;
  for (std::uint32_t id = start.plus_node_id ? 1 : 0; id <= (start.plus_node_id ? last_node_id : 0); ++id) {
    const std::uint32_t can_id = (start.cob_id & 0x1FFF'FFFF) + id;
    if (can_id > 0x7FF || is_restricted_for(start.index, can_id)) return false;
  }
  return true;
}

namespace cob_id_detail {

template <class Object, class Id, bool Legal>
struct CheckedCobId {
  static_assert(Legal, "COB-ID: it is restricted, or has more than 11 bits, for some node-ID (CiA 301, 7.3.5)");
  static constexpr bool is_legal = true;
};

template <StartCobId CobIdType>
struct Labelled {
  static constexpr std::uint16_t index = CobIdType.index;
  static constexpr std::uint8_t sub_index = CobIdType.sub_index;
  /// For node-ID 1, if the node-ID is added.
  static constexpr std::uint32_t can_id = (CobIdType.cob_id & 0x1FFF'FFFF) + (CobIdType.plus_node_id ? 1 : 0);
};

}  // namespace cob_id_detail

/// Whether a device may start with these COB-IDs; does not compile if it may not.
template <StartCobId... CobIdType>
[[nodiscard]] constexpr bool checked_cob_ids() {
  using namespace cob_id_detail;
  return (true && ... &&
          CheckedCobId<pdo_detail::LabelOf<Labelled<CobIdType>>, pdo_detail::CanIdLabel<Labelled<CobIdType>::can_id>,
                       is_legal(CobIdType)>::is_legal);
}

}  // namespace canopen
