/// What CiA 301 requires of each frame of a device, whatever the case tests.
#pragma once

#include <cstdint>

#include "conform/dut/dut.hpp"

namespace edsc::conform {

/// Whether the code is in the table of abort codes (CiA 301, 7.2.4.3.17, table 22). All others are reserved, 0 as well.
[[nodiscard]] bool is_abort_code_of_cia301(std::uint32_t code);

/// Checks the frames that were received during a case: abort codes of the default SDO, and the EMCYs with the default
/// COB-ID. Fails, or adds a warning. Call it when the case has passed.
void expect_valid_frames(Dut& dut);

}  // namespace edsc::conform
