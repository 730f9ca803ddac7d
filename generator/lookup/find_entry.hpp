/// Finds an entry of a device by index and sub-index, or by name.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "device/entry_address.hpp"

namespace edsc {

/// Parses `6064h`, `1018h:02`, `0x6064`, `0x1018:2`, `6064`. After an index with h the sub-index is hexadecimal, as
/// edsc writes it; after 0x it is decimal unless it has a 0x itself. Nothing if the text is not an address.
[[nodiscard]] std::optional<EntryAddress> parse_entry_address(std::string_view text);

/// The result: an object, and an entry of it if the text names one, or if the object does not have sub-indices.
struct FoundEntry {
  const Object* object = nullptr;
  const Entry* entry = nullptr;
  std::string problem;  ///< error message with suggestions; empty if an object was found

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Finds entries of one device, whose objects do not change while it exists.
class EntryFinder {
 public:
  explicit EntryFinder(const NamedDevice& named);

  /// Finds by address; by identifier, `position_actual_value`, `identity_object.vendor_id` or, as in DBC files and
  /// networks, `identity_object_vendor_id`; by its C++ name, `od::identity_object::vendor_id`; or by the name in the
  /// EDS, `Identity object.Vendor-ID`, ignoring letter case. The name of a sub-index is sufficient if only one object
  /// has it; an element of an array is `name.3` or `name[3]`.
  [[nodiscard]] FoundEntry find(std::string_view text);

  /// The same for a single entry: an object with sub-indices is an error that lists them.
  [[nodiscard]] FoundEntry find_one(std::string_view text);

 private:
  /// What has a name: all of one kind, in the order of the device.
  template <class Named>
  struct Names {
    std::unordered_map<std::string, std::vector<Named>> by_name;        ///< in lower case; of EDS and identifiers
    std::unordered_map<std::string, std::vector<Named>> by_identifier;  ///< as `Identifiers` has them
  };
  struct NamedEntry {
    const Object* object;
    const Entry* entry;
    auto operator<=>(const NamedEntry&) const = default;
  };

  /// Some can be in both, each in the order of the device.
  template <class Named>
  struct Matches {
    std::span<const Named> by_name;
    std::span<const Named> by_identifier;
  };

  template <class Named>
  static Matches<Named> find_named(const Names<Named>& names, std::string_view text);

  [[nodiscard]] const Object* find_object(std::string_view text) const;
  [[nodiscard]] std::optional<FoundEntry> by_both_names(std::string_view text) const;
  [[nodiscard]] FoundEntry by_entry_name(std::string_view text);
  [[nodiscard]] FoundEntry find_new(std::string_view text);
  [[nodiscard]] std::string near_names(std::string_view text);

  NamedDevice named_;
  Names<const Object*> objects_;
  Names<NamedEntry> entries_;
  std::unordered_map<std::string, NamedEntry> by_full_name_;  ///< of objects with sub-indices
  std::unordered_map<std::string, FoundEntry> found_;         ///< by the text
  std::size_t suggestions_ = 0;                               ///< number of names for which similar ones were listed
};

/// Finds one text.
[[nodiscard]] FoundEntry find_entry(const NamedDevice& named, std::string_view text);
[[nodiscard]] FoundEntry find_one_entry(const NamedDevice& named, std::string_view text);

}  // namespace edsc
