/// The canonical form of an EDS or DCF: order, spelling and counts of CiA 306-1. Only duplicate sections and keys are
/// lost, which the reader ignores too.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// `sheet` and `device` are those of `ini`.
[[nodiscard]] Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device);

}  // namespace edsc
