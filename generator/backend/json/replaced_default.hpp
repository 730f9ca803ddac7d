/// The default values in whose place a device has the values of a DCF.
#pragma once

#include <optional>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

/// The DefaultValue of an entry whose `default_value` is the ParameterValue.
struct ReplacedDefault {
  std::optional<Value> default_value;  ///< nothing if the DCF does not state one
};

/// Returns nothing if the DCF does not configure the entry. A value that CiA 301 fixes remains the default value.
[[nodiscard]] std::optional<ReplacedDefault> replaced_default(const Entry& entry, const DataSheet& sheet,
                                                              const ObjectDescription& object, const Device& device);

}  // namespace edsc
