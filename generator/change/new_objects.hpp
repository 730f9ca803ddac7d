/// New objects as sections: described by the user, of CiA 301 and the device profiles, or copied.
#pragma once

#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "change/change.hpp"
#include "change/sheet_text.hpp"
#include "device/device.hpp"

namespace edsc {

/// A value of a new object. Empty texts are keys that the section does not get.
struct NewValue {
  std::string name;
  const canopen::DataTypeRow* type = nullptr;
  std::string access = "rw";
  std::string default_value = {}, low_limit = {}, high_limit = {}, unit = {}, factor = {};
  bool mappable = false;
  std::uint8_t sub_index = 0;  ///< 0: the one after that of the value before
};

struct NewObject {
  std::uint16_t index = 0;
  ObjectType type = ObjectType::var;
  std::string name;
  std::vector<NewValue> values;     ///< of a VAR one; of an ARRAY or RECORD those from sub-index 1
  bool has_writable_count = false;  ///< sub-index 0 is not constant
};

/// The sections of an object. `notation`: of the sub-indices in the names of sections.
[[nodiscard]] std::vector<NewSection> sections_of(const NewObject& object, SubIndexNotation notation);

/// An object of CiA 301, or of the profile (0: none). `elements`: of an ARRAY. Nothing if edsc does not have it, or not
/// the data types of its entries.
[[nodiscard]] std::optional<NewObject> standard_object(std::uint16_t index, std::uint16_t profile,
                                                       std::uint8_t elements);

/// The sections of an object with another index; empty if the text does not have the object.
[[nodiscard]] std::vector<NewSection> copied_sections(const SheetText& text, std::uint16_t from, std::uint16_t to);

/// The indices of the objects of a text, ascending.
[[nodiscard]] std::vector<std::uint16_t> object_indices(const SheetText& text);

}  // namespace edsc
