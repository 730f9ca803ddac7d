/// Sections of the data sheet other than those of objects, with their numbers read.
#pragma once

#include "device/information.hpp"
#include "device/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

[[nodiscard]] Information resolve_information(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics);

/// An UNSIGNED32; nothing, with a warning, when the field holds something else. An empty field holds nothing.
[[nodiscard]] std::optional<std::uint32_t> read_number(const Field& field, WarningRule rule, Diagnostics& diagnostics);

}  // namespace edsc
