/// Text for the parts of an EDS that are ignored.
#pragma once

#include <string>
#include <vector>

#include "device/left_out.hpp"
#include "load/load_device.hpp"

namespace edsc {

/// Parts that the device does not have, and PDOs that are not generated because of an invalid COB-ID.
[[nodiscard]] std::vector<LeftOut> all_left_out(const LoadedDevice& loaded);

/// A line for each part, `drive.eds:70:2: skipped: TPDO 1`. Needed since the findings may not state it: with
/// --keep-going a finding states only what is wrong, silenced rules report nothing, and frequent findings are counted
/// only.
[[nodiscard]] std::string left_out_text(const std::vector<LeftOut>& left_out);

}  // namespace edsc
