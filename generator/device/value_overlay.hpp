/// Values that take the place of default values of a device, such as those of a network file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A value of an entry.
struct Setting {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  Value value;
};

/// Settings in the order in which they were made. An entry can have several; the last one applies.
class ValueOverlay {
 public:
  void set(const Entry& entry, Value value);
  /// The setting that applies to an entry; null if it has none.
  [[nodiscard]] const Setting* find(std::uint16_t index, std::uint8_t sub_index) const;
  /// The value of an entry: that of its setting, otherwise its default value; null without both.
  [[nodiscard]] const Value* value_of(const Entry& entry) const;

  [[nodiscard]] bool empty() const { return settings_.empty(); }
  [[nodiscard]] std::size_t size() const { return settings_.size(); }
  [[nodiscard]] auto begin() const { return settings_.begin(); }
  [[nodiscard]] auto end() const { return settings_.end(); }

 private:
  std::vector<Setting> settings_;
  std::map<EntryKey, std::size_t> last_;  ///< the places of those that apply
};

/// The device with the values of an overlay as default values. Its PDOs are those of these values; `of_mapping` gets
/// the findings about them.
[[nodiscard]] Device with_values(const Device& device, const ValueOverlay& values, const Options& options,
                                 Diagnostics& of_mapping);

}  // namespace edsc
