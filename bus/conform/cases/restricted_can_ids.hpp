/// Restricted CAN-IDs (CiA 301, 7.3.5): case 8.10.
#pragma once

#include "conform/dut/dut.hpp"

namespace edsc::conform {

/// Each writable COB-ID refuses the restricted CAN-IDs.
void restricted_can_ids(Dut& dut);

}  // namespace edsc::conform
