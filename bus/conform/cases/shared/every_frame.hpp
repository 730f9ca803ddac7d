/// What CiA 301 requires of each frame of a device, whatever the case tests.
#pragma once

#include <cstdint>

#include "conform/case.hpp"
#include "conform/dut/dut.hpp"

namespace edsc::conform {

/// Whether the code is in the table of abort codes (CiA 301, 7.2.4.3.17, table 22). All others are reserved, 0 as well.
[[nodiscard]] bool is_abort_code_of_cia301(std::uint32_t code);

/// Checks the frames that were received during a case: fails for an abort code of the default SDO that CiA 301 does not
/// have. A wrong error register in an EMCY with the default COB-ID fails the cases of area 5 that test the EMCY
/// service; in others it adds a warning, so that one fault of the device does not fail each case with an EMCY. Call it
/// when the case has passed.
void expect_valid_frames(Dut& dut, const CaseRow& row);

}  // namespace edsc::conform
