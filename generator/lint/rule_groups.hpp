/// The rules other than those for single values and mappings, grouped by subject.
#pragma once

#include "backend/cpp/cpp_names.hpp"
#include "lint/rule_context.hpp"

namespace edsc {

/// [FileInfo], [DummyUsage], [DeviceComissioning], encoding and line lengths.
void check_file(const RuleContext& context);
/// [DeviceInfo], alone and against the objects.
void check_device_info(const RuleContext& context);
/// Mandatory objects, and default values against limits.
void check_objects(const RuleContext& context);
/// Objects that others require, and reserved indices.
void check_presence(const RuleContext& context);
/// The communication profile's objects against CiA 301.
void check_standard_objects(const RuleContext& context);
/// Sub-indices 0 and FFh of ARRAYs and RECORDs.
void check_sub_index_0(const RuleContext& context);
/// Keys of single entries.
void check_entries(const RuleContext& context);
/// Values of the communication profile other than COB-IDs.
void check_communication_values(const RuleContext& context);
/// COB-IDs, alone and against each other.
void check_cob_ids(const RuleContext& context);
/// PDO communication parameters, and that each PDO has both of its parameters.
void check_pdo_communication(const RuleContext& context);
/// Writable entries that no write can change, and default values that the device would reject in a write.
void check_writes(const RuleContext& context);
/// PDO mapping parameters as a whole; single entries are checked by mark_broken_pdos().
void check_pdo_mapping(const RuleContext& context);
/// Multiplex PDOs and their lists.
void check_mpdos(const RuleContext& context);
/// Requirements of the device profile in 1000h.
void check_profile(const RuleContext& context);
/// Units, named values and fields of the options and the EDS.
void check_meanings(const RuleContext& context);
/// Names as C++ identifiers.
void check_names(const RuleContext& context, const CppNames& names);

}  // namespace edsc
