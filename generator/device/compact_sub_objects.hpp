/// CompactSubObj, [HHHHName], [HHHHValue] and [HHHHDenotation] (CiA 306-1, 4.6.2.6): short for sections of sub-objects.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "eds/data_sheet.hpp"

namespace edsc {

/// How many sub-objects CompactSubObj stands for: 0..254. Reports what is no such number.
[[nodiscard]] std::uint8_t compact_count(const ObjectDescription& description, Diagnostics& diagnostics);

/// Whether there is anything to unfold.
[[nodiscard]] bool has_compact_form(const ObjectDescription& description);

/// All sub-objects as if each had its own section, ascending by sub-index; those with a section of their own come from
/// that. In a DCF [HHHHValue] holds ParameterValues, in an EDS DefaultValues. Texts that stand nowhere in the file go
/// to `texts`.
[[nodiscard]] std::vector<SubObjectDescription> unfold_sub_objects(const ObjectDescription& description, bool is_dcf,
                                                                   std::deque<std::string>& texts,
                                                                   Diagnostics& diagnostics);

}  // namespace edsc
