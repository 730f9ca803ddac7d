/// Reads the configuration of a node: the values that a DCF could hold.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

struct ReadValue {
  LiveEntry entry;
  std::vector<std::uint8_t> bytes;
};

struct UnreadValue {
  LiveEntry entry;
  SdoOutcome outcome;
};

struct NodeConfiguration {
  std::vector<ReadValue> values;
  std::vector<LiveEntry> process_data;  ///< what a valid RPDO writes, and what a profile lets masters command with
  std::vector<UnreadValue> unread;      ///< without entries that have no value now
  bool lost = false;                    ///< the node did not answer any more
};

/// The entries that can be read and written, ascending, without DOMAINs and what `is_left_out` and ObjFlags name.
[[nodiscard]] std::vector<LiveEntry> configuration_entries(const Device& device);

/// Reads these entries. Of a mapping parameter only as many entries as its sub-index 0 says. `progress` is called before
/// each entry. Throws Interrupted, BusLost.
[[nodiscard]] NodeConfiguration read_configuration(SdoAccess& node, const Device& device,
                                                   const std::vector<LiveEntry>& entries,
                                                   const std::function<void(std::size_t done)>& progress);

}  // namespace edsc
