/// Resolves the sections of a data sheet other than those of objects.
#pragma once

#include "device/information.hpp"
#include "device/options/options.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

[[nodiscard]] Information resolve_information(const DataSheet& sheet, const Options& options, Diagnostics& diagnostics);

/// Reads an UNSIGNED32. Returns nothing for an empty field, and for an invalid one, which is reported.
[[nodiscard]] std::optional<std::uint32_t> read_number(const Field& field, WarningRule rule, Diagnostics& diagnostics);

}  // namespace edsc
