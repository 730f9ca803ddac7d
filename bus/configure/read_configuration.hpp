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
  std::vector<LiveEntry> process_data;  ///< entries that a valid RPDO writes, or that are commands of the profile
  std::vector<UnreadValue> unread;      ///< except entries that currently have no value
  bool lost = false;                    ///< the node stopped answering
  bool restarted = false;               ///< the node booted up: values from before and after it do not belong together
};

/// The entries that can be read and written, ascending, except DOMAINs and those excluded by `is_left_out` and
/// ObjFlags.
[[nodiscard]] std::vector<LiveEntry> configuration_entries(const Device& device);

/// Reads these entries; of a mapping parameter, only the number of entries in its sub-index 0. `progress` is called
/// before each entry. Ends early if the node is lost or restarts. Throws Interrupted, BusLost.
[[nodiscard]] NodeConfiguration read_configuration(SdoAccess& node, const Device& device,
                                                   const std::vector<LiveEntry>& entries,
                                                   const std::function<void(std::size_t done)>& progress);

}  // namespace edsc
