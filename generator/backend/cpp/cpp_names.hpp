/// C++ names for a device, its objects and entries.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// The names in generated code. They belong to objects and entries by index and sub-index: also to those of a copy of
/// the device with other values.
class CppNames {
 public:
  /// `space`: the namespace of the device; that of the file name if it is empty.
  CppNames(const Device& device, const Options& options, std::string_view space = {});

  [[nodiscard]] const std::string& space() const { return space_; }
  /// Unique in the device.
  [[nodiscard]] const std::string& of(const Object& object) const { return objects_.at(object.index); }
  /// Unique in the object; that of a VAR has the name of its object.
  [[nodiscard]] const std::string& of(const Entry& entry) const { return entries_.at(key_of(entry)); }
  /// The type of an entry in the namespace of its device: `od::statusword`, `od::gains<1>` for an ARRAY of equal
  /// elements, `od::identity::vendor_id`.
  [[nodiscard]] std::string type_of(const Object& object, const Entry& entry) const;

 private:
  [[nodiscard]] static std::uint32_t key_of(const Entry& entry) { return entry.index * 0x100u + entry.sub_index; }
  void name_entries(const Object& object, const Options& options);

  std::string space_;
  std::unordered_map<std::uint16_t, std::string> objects_;
  std::unordered_map<std::uint32_t, std::string> entries_;
};

/// A device and its names.
struct NamedDevice {
  const Device& device;
  const CppNames& names;
};

}  // namespace edsc
