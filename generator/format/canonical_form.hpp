/// The canonical form of an EDS or DCF: order, spelling and counts of CiA 306-1. Only duplicate sections and keys are
/// lost, which the reader ignores too.
#pragma once

#include <string_view>

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// `sheet` and `device` are those of `ini`.
[[nodiscard]] Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device);

/// Whether `text`, which is the text of `ini`, is that of the canonical form. Stops at the first object that is not.
[[nodiscard]] bool is_canonical_form(std::string_view text, const IniFile& ini, const DataSheet& sheet,
                                     const Device& device);

}  // namespace edsc
