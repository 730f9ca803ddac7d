/// The communication parameter of a PDO after a reset, and its possible errors (CiA 301, 7.5.2.35 and 7.5.2.37). Shared
/// by the generator and pdo/pdo_check.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "canopen/can/cob_id.hpp"
#include "canopen/can/node_id.hpp"
#include "canopen/pdo/transmission_type.hpp"

namespace canopen {

/// Default member values are used for parameters that are unknown or do not exist.
struct PdoParameters {
  std::uint32_t cob_id = CobId::invalid_bit;  ///< sub-index 1; without the node-ID if that is added
  bool plus_node_id = false;                  ///< the node-ID is added to the COB-ID
  std::uint8_t transmission_type = 255;       ///< sub-index 2
  std::uint16_t inhibit_time = 0;             ///< sub-index 3, in 100 us
  std::uint16_t event_timer = 0;              ///< sub-index 5, in ms
  bool can_id_is_allowed = false;             ///< although CiA 301 restricts it: DeviceOptions::pdo_allowed_can_ids
  bool compatibility_entry = false;           ///< sub-index 4 exists, although CiA 301 does not use it
};

inline constexpr std::uint32_t highest_node_id = 127;

/// Whether the COB-ID of a PDO can be used: it has 11 bits unless bit 29 is set, and its CAN-ID is not restricted for
/// any node-ID. An invalid COB-ID may have any value.
[[nodiscard]] constexpr bool cob_id_is_legal(const PdoParameters& parameters) {
  const CobId cob_id{parameters.cob_id};
  if (!cob_id.valid() || cob_id.extended()) return true;
  const std::uint32_t base = parameters.cob_id & 0x1FFF'FFFF;
  const std::uint32_t first = base + (parameters.plus_node_id ? 1 : 0);
  const std::uint32_t last = base + (parameters.plus_node_id ? highest_node_id : 0);
  if (last > 0x7FF) return false;
  if (parameters.can_id_is_allowed) return true;
  for (const RestrictedCanIds& range : restricted_can_ids) {
    if (first <= range.last && last >= range.first) return false;
  }
  return true;
}

/// Whether a transmission type is one of CiA 301: 0..240, 254 and 255; for a TPDO also 252 and 253.
[[nodiscard]] constexpr bool transmission_type_is_legal(bool receive, std::uint32_t type) {
  if (type > 255) return false;
  switch (transmission_of(type)) {
    case Transmission::synchronous:
    case Transmission::event_driven: return true;
    case Transmission::remote_synchronous:
    case Transmission::remote: return !receive;
    case Transmission::reserved: break;
  }
  return false;
}

/// Whether the inhibit time is used: by a TPDO of transmission type 254 or 255.
[[nodiscard]] constexpr bool inhibit_time_is_used(bool receive, std::uint32_t type) {
  return !receive && transmission_of(type) == Transmission::event_driven;
}

/// Whether the event timer is used: it triggers a TPDO of transmission type 254 or 255, and monitors an RPDO
/// of any type.
[[nodiscard]] constexpr bool event_timer_is_used(bool receive, std::uint32_t type) {
  return receive || transmission_of(type) == Transmission::event_driven;
}

/// The COB-ID of one PDO of a device.
struct PdoCobId {
  bool receive = false;
  std::uint32_t cob_id = CobId::invalid_bit;
  bool plus_node_id = false;
};

/// Two PDOs of a list with the same CAN-ID, for at least one node-ID.
struct CobIdClash {
  bool found = false;
  std::size_t first = 0;
  std::size_t second = 0;
};

namespace pdo_detail {

/// Maps each CAN-ID to the TPDO that uses it: its position in the list + 1. 29-bit CAN-IDs are rare, and compared
/// one by one.
class TpdoCanIds {
 public:
  /// Returns the TPDO that uses the CAN-ID of this PDO; 0 if there is none.
  [[nodiscard]] constexpr std::size_t user_of(const PdoCobId& pdo) const {
    const std::uint32_t base = CobId{pdo.cob_id}.can_id();
    if (pdo.plus_node_id) {
      if (with_node_id_[base] != 0) return with_node_id_[base];
      for (std::uint32_t id = 1; plain_count_ > 0 && id <= highest_node_id && base + id < can_ids; ++id) {
        if (plain_[base + id] != 0) return plain_[base + id];
      }
      return 0;
    }
    if (plain_[base] != 0) return plain_[base];
    for (std::uint32_t id = 1; with_node_id_count_ > 0 && id <= highest_node_id && id <= base; ++id) {
      if (with_node_id_[base - id] != 0) return with_node_id_[base - id];
    }
    return 0;
  }

  constexpr void add(const PdoCobId& pdo, std::size_t place) {
    const std::uint32_t base = CobId{pdo.cob_id}.can_id();
    (pdo.plus_node_id ? with_node_id_ : plain_)[base] = static_cast<std::uint16_t>(place + 1);
    ++(pdo.plus_node_id ? with_node_id_count_ : plain_count_);
  }

 private:
  static constexpr std::size_t can_ids = 0x800;

  std::uint16_t plain_[can_ids] = {};
  std::uint16_t with_node_id_[can_ids] = {};
  unsigned plain_count_ = 0;
  unsigned with_node_id_count_ = 0;
};

/// Of both directions (CiA 301, 7.5.2.35 and 7.5.2.37).
inline constexpr std::size_t max_pdos = 1024;

/// The same for 29-bit CAN-IDs: PDOs with the same one are neighbours when sorted by it.
[[nodiscard]] constexpr CobIdClash find_extended_clash(const PdoCobId* pdos, std::size_t count) {
  std::array<std::uint16_t, max_pdos> sorted{};
  std::size_t size = 0;
  for (std::size_t i = 0; i < count && size < max_pdos; ++i) {
    const CobId cob_id{pdos[i].cob_id};
    if (cob_id.valid() && cob_id.extended()) sorted[size++] = static_cast<std::uint16_t>(i);
  }
  const auto key = [pdos](std::uint16_t i) {
    return CobId{pdos[i].cob_id}.can_id() << 1 | (pdos[i].plus_node_id ? 1U : 0U);
  };
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(size),
            [key](std::uint16_t a, std::uint16_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t i = 1; i < size; ++i) {
    const std::uint16_t first = sorted[i - 1], second = sorted[i];
    const bool may_share = pdos[first].receive && pdos[second].receive;  // several RPDOs may consume one frame
    if (!may_share && key(first) == key(second)) return {true, first, second};
  }
  return {};
}

}  // namespace pdo_detail

/// Finds the first two of `count` PDOs of a device with the same CAN-ID: each frame has one producer. Several RPDOs may
/// consume the same frame. PDOs that are not valid are ignored.
[[nodiscard]] constexpr CobIdClash find_cob_id_clash(const PdoCobId* pdos, std::size_t count) {
  pdo_detail::TpdoCanIds tpdos;
  for (const bool receive : {false, true}) {
    for (std::size_t i = 0; i < count; ++i) {
      const CobId cob_id{pdos[i].cob_id};
      if (pdos[i].receive != receive || !cob_id.valid() || cob_id.extended()) continue;
      if (const std::size_t user = tpdos.user_of(pdos[i]); user != 0) {
        return user - 1 < i ? CobIdClash{true, user - 1, i} : CobIdClash{true, i, user - 1};
      }
      if (!receive) tpdos.add(pdos[i], i);
    }
  }
  return pdo_detail::find_extended_clash(pdos, count);
}

}  // namespace canopen
