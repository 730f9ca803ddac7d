/// The state of a TPDO between its transmissions.
#pragma once

#include <cstdint>

#include "canopen/base/deadline.hpp"

namespace canopen {

struct TpdoSlot {
  /// Bits of `flags`.
  enum Flag : std::uint8_t {
    changed_bit = 2,    ///< a mapped object has a new value
    due = 4,            ///< due at a SYNC
    timed = 8,          ///< event_due is valid
    inhibited = 16,     ///< inhibit_end is valid
    event_driven = 32,  ///< of type 254 or 255
    before_start = 64,  ///< the SYNC with the start value has not been received yet
    asked = 128,        ///< requested by a remote frame
  };

  struct Times {
    Deadline event_due;
    Deadline inhibit_end;
  };

  Times times;  ///< for type 252, which does not use them, the data of the last SYNC
  std::uint8_t flags;
  std::uint8_t type;
  std::uint8_t syncs;  ///< types 1..240: SYNCs until it is due
  std::uint8_t size;   ///< data bytes
};

}  // namespace canopen
