/// The values of a DCF as steps at a live node.
#pragma once

#include <cstdint>
#include <vector>

#include "format/dcf/write_order.hpp"
#include "online/live_entry.hpp"

namespace edsc {

/// One value that a DCF configures.
struct ConfigurationValue {
  LiveEntry entry;
  std::vector<std::uint8_t> bytes;
  Position position;  ///< in the DCF; no file for a concise DCF
};

/// A step of `order_writes`.
struct ConfigurationStep {
  StepKind kind = StepKind::write;
  LiveEntry entry;
  const ConfigurationValue* value = nullptr;  ///< null if the DCF does not configure this entry
  std::vector<std::uint8_t> bytes;            ///< to write; of `switch_on` empty if the DCF does not configure it
  std::uint32_t off_set = 0;                  ///< COB-ID: bits that are set, and cleared, while it is disabled
  std::uint32_t off_cleared = 0;
  unsigned group = 0;  ///< if a step fails, the other steps of its group are skipped; 0: no group
};

/// Whether a value is not part of a configuration: commands (`command_objects`, 1F50h to 1F5Ah), 1020h, which is
/// written at the end, and entries that tools do not write (ObjFlags bit 0).
[[nodiscard]] bool is_left_out(const LiveEntry& entry);

/// Whether the entry sets the node-ID or the bit rate of the node. CiA 301 does not define such an object, so it is
/// recognized by its name, or as 100Bh of CiA 301 V3; without an EDS, only 100Bh is recognized.
[[nodiscard]] bool sets_node_id_or_bit_rate(const LiveEntry& entry);

/// The values that must be written if those with `differs` are different in the node: these, the complete mapping if
/// part of it differs, and the SYNC period with the SYNC counter overflow.
[[nodiscard]] std::vector<ConfigurationValue> values_to_write(const std::vector<ConfigurationValue>& values,
                                                              const std::vector<bool>& differs);

/// Whether the value has an effect: not a mapping entry above the number of mapped objects in the DCF.
[[nodiscard]] bool has_effect(const ConfigurationValue& value, const std::vector<ConfigurationValue>& values);

/// The steps in the order of `order_writes`; finally node-ID and bit rate. `values` must outlive them; `device` is null
/// for a concise DCF.
[[nodiscard]] std::vector<ConfigurationStep> plan_configuration(const std::vector<ConfigurationValue>& values,
                                                                const Device* device);

}  // namespace edsc
