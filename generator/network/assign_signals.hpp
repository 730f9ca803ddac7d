/// Assigns PDOs to the signals of a network file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/network.hpp"

namespace edsc {

/// An entry of a master without a file: the copy of an entry of another node, which it sends or receives.
struct MasterEntry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string node;  ///< whose entry it copies
  std::string name;
  const Entry* original = nullptr;
  bool is_sent = false;
};

/// The object of a master without a file with the values that it sends to a node: `axis1 commands`.
[[nodiscard]] std::string commands_name(const std::string& node);

/// A PDO of a node, as the signals need it.
struct PlannedPdo {
  std::string node;
  PdoDirection direction = PdoDirection::receive;
  std::uint16_t number = 1;
  std::uint32_t cob_id = 0;
  std::uint8_t transmission_type = 255;
  std::optional<std::uint16_t> event_timer_ms;
  std::optional<std::uint64_t> inhibit_time;  ///< in the unit of the device
  std::vector<MappingValue> mapping;
  Position position;               ///< of its first signal
  bool has_stated_can_id = false;  ///< by `set` or a DCF
};

/// The name and unit of a value that a node sends or receives.
struct SignalMeaning {
  std::string node;
  EntryKey entry;
  std::string name;  ///< empty: that of the object
  std::optional<Quantity> quantity;
};

struct SignalPlan {
  std::vector<MasterEntry> master_entries;
  std::vector<PlannedPdo> pdos;
  std::vector<SignalMeaning> meanings;
};

/// Packs the signals of one sender with the same timing and the same receivers into PDOs, in the order of the file. A
/// PDO of a device is used if it has the mapping already, or if its mapping can be changed; the lowest number first.
/// What cannot be assigned is reported.
[[nodiscard]] SignalPlan plan_signals(const Network& network, Diagnostics& diagnostics);

/// Sets the parameters of the planned PDOs of a node, and the names and units of their values.
void apply_signals(NetworkNode& node, const SignalPlan& plan, Diagnostics& diagnostics);

}  // namespace edsc
