/// CompactSubObj, [HHHHName], [HHHHValue] and [HHHHDenotation] (CiA 306-1, 4.6.2.6): the compact form of sub-objects.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "eds/data_sheet.hpp"

namespace edsc {

/// The number of sub-objects in CompactSubObj: 0..254. Reports an invalid number.
[[nodiscard]] std::uint8_t compact_count(const ObjectDescription& description, Diagnostics& diagnostics);

/// Whether the object has a compact form.
[[nodiscard]] bool has_compact_form(const ObjectDescription& description);

/// All sub-objects as if each had its own section, ascending by sub-index; existing sections take precedence.
/// [HHHHValue] contains ParameterValues in a DCF, DefaultValues in an EDS. `texts` stores texts that do not occur in
/// the file.
[[nodiscard]] std::vector<SubObjectDescription> unfold_sub_objects(const ObjectDescription& description, bool is_dcf,
                                                                   std::deque<std::string>& texts,
                                                                   Diagnostics& diagnostics);

}  // namespace edsc
