/// The order in which the values of a DCF go to a node: what may change only while something is off goes when it is
/// off.
#pragma once

#include <cstdint>
#include <vector>

#include "online/live_entry.hpp"

namespace edsc {

/// One value that a DCF configures.
struct ConfigurationValue {
  LiveEntry entry;
  std::vector<std::uint8_t> bytes;
  Position position;  ///< in the DCF; no file where it is a concise one
};

enum class StepKind : std::uint8_t {
  write,       ///< the value
  switch_off,  ///< COB-ID: read it, and write it with the bits that make it off; nothing where it is off
  switch_on,   ///< COB-ID: write the value, or what was read before where the DCF has none
  clear,       ///< write 0: the number of mapped objects, or a period
  restore,     ///< write what `clear` found, or `bytes` where that is more
};

struct ConfigurationStep {
  StepKind kind = StepKind::write;
  LiveEntry entry;
  const ConfigurationValue* value = nullptr;  ///< null where the DCF says nothing of this entry
  std::vector<std::uint8_t> bytes;            ///< to write; of `switch_on` empty where the DCF says nothing
  std::uint32_t off_set = 0;                  ///< COB-ID: bits that are set, and cleared, when it is off
  std::uint32_t off_cleared = 0;
  unsigned group = 0;  ///< steps of one group other than 0 are given up together
};

/// Values that command rather than configure (`command_objects`, 1F50h to 1F5Ah), 1020h, which is written at the end, and
/// what tools leave alone (ObjFlags bit 0).
[[nodiscard]] bool is_left_out(const LiveEntry& entry);

/// Whether the entry sets the node-ID or the bit rate of its own CAN interface. CiA 301 has no such object, so it is
/// known by its name, and 100Bh of CiA 301 V3; without an EDS only 100Bh is known.
[[nodiscard]] bool sets_node_id_or_bit_rate(const LiveEntry& entry);

/// The values that must be written when those with `differs` are not what the node has: these, all that counts of a
/// mapping of which a part differs, and the SYNC period with the SYNC overflow.
[[nodiscard]] std::vector<ConfigurationValue> values_to_write(const std::vector<ConfigurationValue>& values,
                                                              const std::vector<bool>& differs);

/// Whether the value takes effect: not a mapping entry above the number of mapped objects that the DCF has.
[[nodiscard]] bool has_effect(const ConfigurationValue& value, const std::vector<ConfigurationValue>& values);

/// The steps, in order: communication parameters, application, then each PDO: its COB-ID off, number of mapped objects
/// 0, mapping, number, other parameters, COB-ID; at last node-ID and bit rate. `values` must outlive them; `device` is null for a concise DCF.
[[nodiscard]] std::vector<ConfigurationStep> plan_configuration(const std::vector<ConfigurationValue>& values,
                                                                const Device* device);

}  // namespace edsc
