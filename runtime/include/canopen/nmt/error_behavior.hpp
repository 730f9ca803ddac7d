/// Error behaviour 1029h: the NMT state after a serious error (CiA 301, 7.5.2.32).
#pragma once

#include <cstdint>

#include "canopen/base/abort_code.hpp"
#include "canopen/nmt/nmt.hpp"

namespace canopen {

/// Reaction to an error class of 1029h. Sub-index 1 is the class of communication errors: bus-off, life guarding event,
/// heartbeat event; a device without 1029h reacts as with 0.
enum class ErrorBehavior : std::uint8_t {
  pre_operational = 0,  ///< from Operational to Pre-operational; other states do not change
  no_change = 1,
  stopped = 2,
};

/// Returns the state after an error of a class. Reserved values do not change the state.
[[nodiscard]] constexpr NmtState state_after_error(NmtState state, std::uint8_t behavior) {
  if (state == NmtState::initialisation) return state;
  switch (static_cast<ErrorBehavior>(behavior)) {
    case ErrorBehavior::pre_operational: return state == NmtState::operational ? NmtState::pre_operational : state;
    case ErrorBehavior::no_change: return state;
    case ErrorBehavior::stopped: return NmtState::stopped;
  }
  return state;
}

/// Checks a value for a class of 1029h. 0609 0030h: it is reserved; 128..255 are manufacturer-specific.
[[nodiscard]] constexpr AbortCode check_error_behavior(std::uint8_t behavior) {
  const bool reserved = behavior > static_cast<std::uint8_t>(ErrorBehavior::stopped) && behavior < 0x80;
  return reserved ? AbortCode::invalid_value : ok;
}

}  // namespace canopen
