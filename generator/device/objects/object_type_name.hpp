/// ObjectType as a word instead of a number.
#pragma once

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// The object code of this name; nothing if unknown.
[[nodiscard]] inline std::optional<ObjectType> object_type_named(std::string_view text) {
  constexpr std::array named = {ObjectType::domain, ObjectType::var, ObjectType::array, ObjectType::record};
  for (const ObjectType type : named) {
    if (equal_ignoring_case(text, to_string(type))) return type;
  }
  return std::nullopt;
}

inline void report_object_type_name(ObjectType type, const Field& field, Diagnostics& diagnostics) {
  diagnostics.warning(
      "object-type", field.position,
      fmt::format("ObjectType must be a number; that of {} is 0x{:X}", to_string(type), static_cast<unsigned>(type)),
      {}, std::string{to_string(type)});
}

}  // namespace edsc
