/// The canonical form of an EDS or DCF: order, spelling and counts as CiA 306-1 has them, nothing lost but what the
/// reader does not take either: second sections and keys of the same name.
#pragma once

#include "device/device.hpp"
#include "eds/data_sheet.hpp"
#include "format/document.hpp"

namespace edsc {

/// `sheet` and `device` are those of `ini`.
[[nodiscard]] Document canonical_form(const IniFile& ini, const DataSheet& sheet, const Device& device);

}  // namespace edsc
