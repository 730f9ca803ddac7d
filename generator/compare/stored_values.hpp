/// What happens to the stored parameters of a device when it gets the firmware of another version.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backend/cpp/placement.hpp"
#include "compare/change.hpp"
#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A device with the options that decide what it stores.
struct StoringDevice {
  const Device& device;
  const Options& options;
};

/// The entries of which 1010h stores the values: the same selection as that of canopen::ParameterLayout.
class StoredEntries {
 public:
  explicit StoredEntries(const StoringDevice& storing);

  [[nodiscard]] bool contains(const Object& object, const Entry& entry) const;

 private:
  /// Whether the options store an entry; nothing: they do not say.
  [[nodiscard]] std::optional<bool> by_options(const Entry& entry) const;

  Placement placement_;
  std::map<std::pair<std::uint16_t, std::optional<std::uint8_t>>, bool> by_options_;  ///< objects and entries
  std::set<EntryKey> mapped_by_default_;
};

enum class StoredFate : std::uint8_t {
  kept,       ///< loaded, unless the new limits exclude it
  converted,  ///< passed to the application, which can convert it; otherwise not loaded
  dropped,    ///< the same, but the entry does not store values any more
};
[[nodiscard]] std::string_view to_string(StoredFate fate);

struct StoredValueChange {
  StoredFate fate = StoredFate::kept;
  std::string entry;  ///< `2000h:00`
  std::string name;
  std::string why;  ///< empty: every stored value is kept
  Position old_position;
  Position new_position;
};

/// Returns the fate of each value that the old device stores, ascending by entry.
[[nodiscard]] std::vector<StoredValueChange> compare_stored_values(const StoringDevice& before,
                                                                   const StoringDevice& after);

/// Adds a change for each value that is not kept.
void add_lost_values(const std::vector<StoredValueChange>& values, Changes& changes);

/// A line for each value, and a summary.
[[nodiscard]] std::string stored_values_as_text(const std::vector<StoredValueChange>& values);
[[nodiscard]] std::string stored_values_as_markdown(const std::vector<StoredValueChange>& values);
/// docs/schema/diff_storage.schema.json
[[nodiscard]] nlohmann::ordered_json stored_values_as_json(const std::vector<StoredValueChange>& values);

}  // namespace edsc
