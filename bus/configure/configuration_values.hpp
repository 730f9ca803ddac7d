/// The values that a DCF or a concise DCF configures.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "configure/configuration_plan.hpp"
#include "configure/configure_node.hpp"
#include "diagnostics/diagnostics.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct Configuration {
  std::vector<ConfigurationValue> values;  ///< except those that are ignored
  std::size_t left_out = 0;                ///< `is_left_out`
  std::optional<ConfigurationTime> time;   ///< of 1020h
};

/// The ParameterValues of a DCF, and its values for 1020h, or else the date of the file. Invalid values are reported
/// and ignored. The result refers to `device`, which is that of `dcf`, with the node-ID.
[[nodiscard]] Configuration configuration_of(const DataSheet& dcf, const Device& device, Diagnostics& diagnostics);

/// The values of a concise DCF, of an entry that it writes twice the last one; nothing if its length does not match its
/// contents. `device` may be null.
[[nodiscard]] std::optional<Configuration> configuration_of(std::string_view concise_dcf, const Device* device);

}  // namespace edsc
