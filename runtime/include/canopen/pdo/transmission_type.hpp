/// When a PDO is sent or applied: sub-index 02h of its communication parameter (CiA 301, 7.5.2.35 and 7.5.2.37).
#pragma once

#include <cstdint>

namespace canopen {

enum class Transmission : std::uint8_t {
  synchronous,         ///< 0..240: at a SYNC
  reserved,            ///< 241..251, for an RPDO up to 253
  remote_synchronous,  ///< 252: sampled at a SYNC, sent on request
  remote,              ///< 253: sent on request
  event_driven,        ///< 254, 255: sent or applied at once
};

[[nodiscard]] constexpr Transmission transmission_of(std::uint32_t transmission_type) {
  if (transmission_type >= 254) return Transmission::event_driven;
  if (transmission_type <= 240) return Transmission::synchronous;
  if (transmission_type == 252) return Transmission::remote_synchronous;
  return transmission_type == 253 ? Transmission::remote : Transmission::reserved;
}

}  // namespace canopen
