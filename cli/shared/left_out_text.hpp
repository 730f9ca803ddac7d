/// What a device does not have of its data sheet, as text.
#pragma once

#include <string>
#include <vector>

#include "device/left_out.hpp"
#include "load/load_device.hpp"

namespace edsc {

/// What the device does not have, and PDOs that are not generated since their COB-ID is wrong.
[[nodiscard]] std::vector<LeftOut> all_left_out(const LoadedDevice& loaded);

/// A line for each, `drive.eds:70:2: left out: TPDO 1`. Needed where the findings do not say it: with --keep-going a finding
/// says what is wrong, a silenced rule says nothing, and one that fires often is counted only.
[[nodiscard]] std::string left_out_text(const std::vector<LeftOut>& left_out);

}  // namespace edsc
