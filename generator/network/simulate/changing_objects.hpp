/// The objects to which a simulation gives new values, so that TPDOs are sent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "network/cob_id_use.hpp"
#include "network/network.hpp"
#include "network/timing/timing.hpp"

namespace edsc {

/// An object with the values low, low + 1, ..., low + range, modulo 2^64.
struct ChangingObject {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t bytes = 0;
  std::uint64_t low = 0;
  std::uint64_t range = 0;
};

/// The objects of one TPDO.
struct ChangingPdo {
  std::size_t message = 0;  ///< place in NetworkTiming::messages
  Nanoseconds interval{};
  bool is_event_driven = false;
  bool has_event_timer = false;  ///< and nothing else limits its rate
  bool has_receiver = false;     ///< a node of the network has an RPDO for it
  std::vector<ChangingObject> objects;
};

/// Returns the TPDOs of a node with the objects that they map. An object that several TPDOs map belongs to the one with
/// the longest interval, event-driven ones first, so that none is sent more often than `timing` assumes. The values are
/// within the limits of the sender and of all receivers. Strings and times do not change.
[[nodiscard]] std::vector<ChangingPdo> changing_pdos(const NetworkNode& node, const std::vector<CobIdUse>& uses,
                                                     const NetworkTiming& timing);

}  // namespace edsc
