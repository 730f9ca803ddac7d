/// Default PDO mappings without a valid layout.
#pragma once

#include <string_view>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Marks PDOs with an invalid mapping as broken and reports why: as an error, but as a warning if the PDO is disabled
/// by default (bit 31 of its COB-ID). A BOOLEAN that is mapped as a byte is accepted with a warning.
void mark_broken_pdos(Device& device, const Options& options, Diagnostics& diagnostics);

/// Whether a diagnostic of this rule marks a PDO as broken.
[[nodiscard]] bool is_broken_pdo_rule(std::string_view rule);

}  // namespace edsc
