/// One run of a configuration: what it compares and writes, and its result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "configure/configuration_plan.hpp"
#include "configure/configuration_values.hpp"
#include "configure/configure_node.hpp"
#include "online/live_bus.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

/// A value that differs from that of the node.
struct ConfigurationChange {
  ConfigurationValue value;
  std::optional<std::vector<std::uint8_t>> before;  ///< nothing if it cannot be read
};

struct ConfigurationRun {
  std::uint8_t node = 0;
  bool all = false;      ///< all values are written, without a comparison
  bool dry_run = false;  ///< nothing is written
  std::size_t left_out = 0;
  std::size_t compared = 0;
  std::vector<ConfigurationChange> changes;   ///< of the compared values
  std::vector<ConfigurationChange> withheld;  ///< node-ID and bit rate, without permission
  std::vector<ConfigurationValue> values;     ///< to write
  std::vector<ConfigurationStep> steps;       ///< for `values`
  ConfigurationResult result;
  bool time_written = false;
  bool stored = false;
  std::vector<std::string> problems;  ///< other than failures of values

  [[nodiscard]] bool succeeded() const { return result.done() && problems.empty(); }
};

/// Chooses all values. Node-ID and bit rate require permission.
void choose_all(ConfigurationRun& run, const Configuration& configuration, bool node_id_and_bit_rate);

/// Chooses the values that differ from those of the node. Returns false if the node stops answering. Throws
/// Interrupted, BusLost.
[[nodiscard]] bool choose_different(ConfigurationRun& run, SdoAccess& node, const Configuration& configuration,
                                    bool node_id_and_bit_rate, const ConfigurationHooks& hooks);

/// Sends the NMT command and waits until the node has executed it.
void enter_pre_operational(LiveBus& bus, canopen::NodeId node);

/// After all values: writes 1020h, if no value is withheld and it differs. Throws Interrupted, BusLost.
void write_time(ConfigurationRun& run, SdoAccess& node, const Configuration& configuration);

/// Stores the parameters of the node (1010h:01). A device may erase flash before it answers: waits five seconds or
/// `timeout_ms`, whichever is longer. Throws Interrupted, BusLost.
void store_parameters(ConfigurationRun& run, SdoAccess& node, unsigned timeout_ms);

}  // namespace edsc
