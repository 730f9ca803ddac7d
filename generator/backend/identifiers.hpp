/// Identifiers of a device, its objects and entries, free of any target language.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// The identifiers in use in one scope.
class IdentifierScope {
 public:
  /// Reserves `wanted`, or the first free one of `wanted` + `suffix`, `wanted` + `suffix` + `_2`, ...
  [[nodiscard]] std::string take(const std::string& wanted, std::string_view suffix);

 private:
  std::unordered_set<std::string> taken_;
};

/// Names of the EDS in snake_case. The names of a target language are a map of its backend over them: an object
/// "Switch" is `switch` here, `switch_` in C++. They belong to objects and entries by index and sub-index: also to
/// those of a copy of the device with other values.
class Identifiers {
 public:
  /// `device_name`: the name of the device, an identifier; that of its file if it is empty.
  Identifiers(const Device& device, const Options& options, std::string_view device_name = {});

  /// `device` if the name of the file does not have a letter or digit.
  [[nodiscard]] const std::string& device() const { return device_; }
  /// Unique in the device: the second `speed` is `speed_2001`.
  [[nodiscard]] const std::string& of(const Object& object) const { return objects_.at(object.index); }
  /// Unique in the object; the identifier of a VAR is the one of its object.
  [[nodiscard]] const std::string& of(const Entry& entry) const { return entries_.at(key_of(entry)); }
  /// The identifier of an entry without its object, as DBC files, signals of a network and C have it: `statusword`,
  /// `identity_object_vendor_id`; of an ARRAY of equal elements `gains_p` if the element has its own name, and else
  /// `gains_1`. C++ has `od::identity_object::vendor_id` and `od::gains<1>` for the parts.
  [[nodiscard]] std::string full(const Entry& entry) const;
  /// `gains_p`: the name of an element of an ARRAY of equal elements if the options give it one, or if its
  /// ParameterName differs from those of the object and of the other elements by more than a number; else null. It is
  /// unique in the device.
  [[nodiscard]] const std::string* element(const Entry& entry) const;

 private:
  [[nodiscard]] static std::uint32_t key_of(const Entry& entry) { return entry.index * 0x100u + entry.sub_index; }
  void name_entries(const Object& object, const Options& options);
  void name_elements(const Object& object, const Options& options, IdentifierScope& of_device);

  std::string device_;
  std::unordered_map<std::uint16_t, std::string> objects_;
  std::unordered_map<std::uint32_t, std::string> entries_;
  std::unordered_map<std::uint32_t, std::string> elements_;
  std::unordered_set<std::uint16_t> vars_;  ///< objects without sub-indices
  std::unordered_set<std::uint16_t> uniform_arrays_;
};

}  // namespace edsc
