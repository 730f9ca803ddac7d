/// The cases of the PDO area; their table is in pdo_cases.cpp.
#pragma once

#include "conform/cases/pdo_area.hpp"

namespace edsc::conform::pdo_area {

// pdo_transmission_cases.cpp
void sends_on_remote_frame(Dut& dut);
void sends_on_event(Dut& dut);
void sends_by_event_timer(Dut& dut);
void sends_at_each_nth_sync(Dut& dut);
void sends_at_sync_after_event(Dut& dut);
void sends_from_sync_start_value(Dut& dut);
// For Stopped and Pre-operational.
void silent_on_remote_frame(Dut& dut, NmtState state);
void silent_on_event(Dut& dut, NmtState state);
void silent_by_event_timer(Dut& dut, NmtState state);
void silent_at_sync(Dut& dut, NmtState state);
void silent_at_sync_after_event(Dut& dut, NmtState state);
void silent_from_sync_start_value(Dut& dut, NmtState state);

// pdo_mapping_cases.cpp
void mapping_fits_dictionary(Dut& dut);
void takes_new_mapping(Dut& dut);
void refuses_entry_of_active_mapping(Dut& dut);
void refuses_mapping_of_valid_pdo(Dut& dut);
void refuses_too_many_objects(Dut& dut);
void refuses_too_many_bits(Dut& dut);
void takes_output_in_rpdo(Dut& dut);
void refuses_input_in_rpdo(Dut& dut);
void refuses_unmappable_in_rpdo(Dut& dut);
void takes_input_in_tpdo(Dut& dut);
void refuses_output_in_tpdo(Dut& dut);
void refuses_unmappable_in_tpdo(Dut& dut);
void takes_dummy_in_rpdo(Dut& dut);

}  // namespace edsc::conform::pdo_area
