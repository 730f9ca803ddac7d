/// The values of the device before a case, and how they are restored.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "online/live_entry.hpp"
#include "online/sdo_access.hpp"

namespace edsc::conform {

/// Records the value of each entry before a case writes it, and the whole configuration before the first reset, which
/// discards what is not stored.
class FoundValues {
 public:
  using Key = std::pair<std::uint16_t, std::uint8_t>;
  using Values = std::map<Key, std::vector<std::uint8_t>>;

  FoundValues(SdoAccess& sdo, const Device& sheet) : sdo_{sdo}, sheet_{sheet} {}

  /// Reads the entry, and with an entry of a PDO all writable parameters of the PDO.
  void remember(std::uint16_t index, std::uint8_t sub_index);
  /// Call before each reset.
  void remember_before_reset();
  /// Restores what was written or reset since the last call. Returns what could not be restored: without
  /// `application`, also what a reset has changed at 2000h and above.
  [[nodiscard]] std::vector<std::string> restore_changed(bool application);
  /// Writes the values that differ now. Returns those that cannot be written; `application` as in `restore_changed`.
  [[nodiscard]] std::vector<std::string> restore(const Values& values, bool application);

 private:
  void remember_entry(const LiveEntry& entry);

  SdoAccess& sdo_;
  const Device& sheet_;
  Values changed_;            ///< values before this case
  Values configuration_;      ///< of the whole device, before the first reset
  std::set<Key> unreadable_;  ///< written, but not readable: not restored
  bool configuration_known_ = false;
  bool was_reset_ = false;
};

}  // namespace edsc::conform
