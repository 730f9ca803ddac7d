/// Parts of a data sheet that the resolved device does not have.
#pragma once

#include <string>
#include <vector>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"

namespace edsc {

struct LeftOut {
  Position position;
  std::string what;  ///< `RPDO 2`, `2000h:01 "Speed"`, `the DefaultValue of 2000h:01 "Speed"`
};

/// Compares the data sheet with the device: missing objects, entries, default values and limits, and PDOs with a broken
/// mapping. Does not depend on which findings were reported or silenced.
[[nodiscard]] std::vector<LeftOut> find_left_out(const DataSheet& sheet, const Device& device);

}  // namespace edsc
