/// Carries out a plan: writes the values of a DCF to a node, and reads them back.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "configure/configuration_plan.hpp"
#include "online/sdo_access.hpp"

namespace edsc {

/// Something that did not go as it should.
struct ConfigurationFailure {
  LiveEntry entry;
  const ConfigurationValue* value = nullptr;  ///< null where the DCF says nothing of this entry
  std::string what;                           ///< `refused by the device: 0609 0030h, invalid value`
};

struct ConfigurationResult {
  std::size_t values = 0;  ///< that were to be written
  std::size_t written = 0;
  std::size_t verified = 0;  ///< read back, and equal
  bool lost = false;         ///< the node did not answer any more, or restarted: the rest was not tried
  bool restarted = false;    ///< values that were written before may be lost
  std::vector<ConfigurationFailure> failures;

  [[nodiscard]] bool done() const { return failures.empty() && !lost; }
};

/// What a run asks for and reports.
struct ConfigurationHooks {
  std::function<void(std::size_t done, std::size_t of)> progress;  ///< before each step
  std::function<bool()> restarted;                                 ///< whether the node has sent a boot-up message
};

/// A value beside what the node has.
struct ComparedValue {
  SdoOutcome found;
  bool differs = false;  ///< also where the node's value cannot be read

  [[nodiscard]] bool known() const { return found.done(); }
};

struct Comparison {
  std::vector<ComparedValue> values;  ///< one for each value, unless the node is lost
  bool lost = false;                  ///< the node did not answer any more
};

/// Reads the values from the node. What is write-only, and what the node does not let be read, differs. What has no
/// effect (`has_effect`) does not. Throws Interrupted, BusLost.
[[nodiscard]] Comparison compare_configuration(SdoAccess& node, const std::vector<ConfigurationValue>& values,
                                               const ConfigurationHooks& hooks);

/// What is refused is tried once more behind all others: limits may
/// depend on values that come later. A PDO of which something is refused stays off. Throws Interrupted, BusLost.
[[nodiscard]] ConfigurationResult configure_node(SdoAccess& node, const std::vector<ConfigurationStep>& steps,
                                                 const ConfigurationHooks& hooks);

/// 1020h: when a configuration was made (CiA 301, 7.5.2.23): days since 1984-01-01, and milliseconds since midnight.
struct ConfigurationTime {
  std::uint32_t date = 0;
  std::uint32_t time = 0;

  friend bool operator==(const ConfigurationTime&, const ConfigurationTime&) = default;
};

/// `05-15-1995` and `02:30PM`, as CiA 306-1 writes them; nothing where they are not so.
[[nodiscard]] std::optional<ConfigurationTime> parse_configuration_time(std::string_view date, std::string_view time);

/// What 1020h of the node holds; nothing when it has none.
[[nodiscard]] std::optional<ConfigurationTime> read_configuration_time(SdoAccess& node);

/// The failure's text; empty when it is written.
[[nodiscard]] std::string write_configuration_time(SdoAccess& node, ConfigurationTime time);

}  // namespace edsc
