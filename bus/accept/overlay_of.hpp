/// The differences in which the EDS is wrong, as an overlay.
#pragma once

#include "accept/compare_dictionary.hpp"
#include "overlay/write_overlay.hpp"

namespace edsc::accept {

/// The corrections of all differences with the mark `eds_wrong`. The reason of each has the frames that show it.
/// Remarks and the path of the base are left to the caller.
[[nodiscard]] NewOverlay overlay_of(const Comparison& comparison);

}  // namespace edsc::accept
