/// Resolves the sections of a data sheet other than those of objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/information.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"
#include "eds/sections/keys.hpp"

namespace edsc {

[[nodiscard]] Information resolve_information(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics);

/// Reads an UNSIGNED32. Returns nothing for an empty field, and for an invalid one, which is reported.
[[nodiscard]] std::optional<std::uint32_t> read_number(const Field& field, WarningRule rule, Diagnostics& diagnostics);

/// The values of a section by the rows of its keys. A number that is not an UNSIGNED32 is reported with `rule`.
template <typename Struct, std::size_t n>
[[nodiscard]] std::vector<SectionValue> section_values(const KeyRow<Struct> (&keys)[n], const Struct& section,
                                                       WarningRule rule, Diagnostics& diagnostics) {
  std::vector<SectionValue> values;
  for (const KeyRow<Struct>& row : keys) {
    if (row.field == nullptr || !(section.*row.field).present) continue;
    const Field& field = section.*row.field;
    if (row.key.value != ValueKind::number) {
      values.push_back({row.key.name, std::string{field.text}});
    } else if (const auto number = read_number(field, rule, diagnostics)) {
      values.push_back({row.key.name, *number});
    }
  }
  return values;
}

}  // namespace edsc
