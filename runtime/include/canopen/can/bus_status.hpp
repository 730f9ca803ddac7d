/// Status of a CAN controller (ISO 11898-1), as a port reports it to its node.
#pragma once

#include <cstdint>

namespace canopen {

enum class BusState : std::uint8_t {
  active,   ///< error active
  passive,  ///< error passive: EMCY 8120h
  off,      ///< bus-off: EMCY 8140h when it has recovered
};

struct BusStatus {
  BusState state = BusState::active;
  bool overrun = false;  ///< frames have been lost since the last report: EMCY 8110h

  friend constexpr bool operator==(const BusStatus&, const BusStatus&) = default;
};

/// Whether a port interrupts, or wakes its loop, when the status becomes error passive or bus-off: it has a constant
/// `has_status_interrupt`. A loop must look at the status of another port now and then.
template <class Type>
inline constexpr bool has_status_interrupt = requires {
  requires Type::has_status_interrupt;
};

}  // namespace canopen
