/// Which entry of a device people mean: by index and sub-index, or by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/device.hpp"

namespace edsc {

/// An index, and a sub-index where one is given.
struct EntryAddress {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub_index;

  friend bool operator==(const EntryAddress&, const EntryAddress&) = default;
};

/// `6064h`, `1018h:02`, `0x6064`, `0x1018:2`, `6064`. Behind an h the sub-index is hexadecimal, as edsc writes it;
/// behind 0x it is decimal unless it has a 0x itself. Nothing when the text is no address.
[[nodiscard]] std::optional<EntryAddress> parse_entry_address(std::string_view text);

/// What was found: an object, of it an entry where the text names one; of an object without sub-indices its only one.
struct FoundEntry {
  const Object* object = nullptr;
  const Entry* entry = nullptr;
  std::string problem;  ///< a sentence, with what may have been meant; empty when an object was found

  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// By address; by name as it is generated, `position_actual_value` or `identity_object.vendor_id`, or as it stands in
/// the data sheet, `Identity object.Vendor-ID`; upper and lower case are the same. The name of a sub-index alone does
/// where only one object has it; an element of an array is `name.3` or `name[3]`.
[[nodiscard]] FoundEntry find_entry(const Device& device, std::string_view text);

/// The same where a whole object is not enough: it is a problem that names its sub-indices.
[[nodiscard]] FoundEntry find_one_entry(const Device& device, std::string_view text);

/// `1018h:01 identity_object.vendor_id`
[[nodiscard]] std::string entry_title(const Object& object, const Entry& entry);

}  // namespace edsc
