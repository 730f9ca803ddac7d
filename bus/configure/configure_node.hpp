/// Executes a plan: writes the values of a DCF to a node, and reads them back.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "configure/configuration_plan.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

/// A step that failed.
struct ConfigurationFailure {
  LiveEntry entry;
  const ConfigurationValue* value = nullptr;  ///< null if the DCF does not configure this entry
  std::string what;                           ///< `refused by the device: 0609 0030h, invalid value`
  Position position{};  ///< of the value, or of one that requires the step; no file for a concise DCF
};

struct ConfigurationResult {
  std::size_t values = 0;  ///< to be written
  std::size_t written = 0;
  std::size_t verified = 0;          ///< read back, and equal
  bool lost = false;                 ///< the node stopped answering, or restarted: the rest was not tried
  bool restarted = false;            ///< values written before may be lost
  std::optional<LiveEntry> lost_at;  ///< the last transfer before that; nothing if none was made
  std::vector<ConfigurationFailure> failures;

  [[nodiscard]] bool done() const { return failures.empty() && !lost; }
};

/// Callbacks of a run.
struct ConfigurationHooks {
  std::function<void(std::size_t done, std::size_t of)> progress;  ///< before each step
  std::function<bool()> restarted;                                 ///< whether the node has sent a boot-up message
};

/// A value and that of the node.
struct ComparedValue {
  SdoOutcome found;
  bool differs = false;  ///< also if the node's value cannot be read

  [[nodiscard]] bool known() const { return found.done(); }
};

struct Comparison {
  std::vector<ComparedValue> values;  ///< one for each value, unless the node is lost
  bool lost = false;                  ///< the node stopped answering
};

/// Reads the values from the node. Entries that cannot be read count as different; values without effect (`has_effect`)
/// do not. Throws Interrupted, BusLost.
[[nodiscard]] Comparison compare_configuration(SdoAccess& node, const std::vector<ConfigurationValue>& values,
                                               const ConfigurationHooks& hooks);

/// A refused value is retried once after all others, since limits may depend on values written later. A PDO with a
/// refused value remains disabled. Throws Interrupted, BusLost.
[[nodiscard]] ConfigurationResult configure_node(SdoAccess& node, const std::vector<ConfigurationStep>& steps,
                                                 const ConfigurationHooks& hooks);

/// 1020h, the date and time of a configuration (CiA 301, 7.5.2.23): days since 1984-01-01, milliseconds since midnight.
struct ConfigurationTime {
  std::uint32_t date = 0;
  std::uint32_t time = 0;

  friend bool operator==(const ConfigurationTime&, const ConfigurationTime&) = default;
};

/// Reads `05-15-1995` and `02:30PM`, the formats of CiA 306-1; nothing for other formats.
[[nodiscard]] std::optional<ConfigurationTime> parse_configuration_time(std::string_view date, std::string_view time);

/// The value of 1020h of the node; nothing if it does not exist.
[[nodiscard]] std::optional<ConfigurationTime> read_configuration_time(SdoAccess& node);

/// Returns an error message; empty on success.
[[nodiscard]] std::string write_configuration_time(SdoAccess& node, ConfigurationTime time);

}  // namespace edsc
