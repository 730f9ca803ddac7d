/// Makes the tables of a device at run time, by the rules by which edsc generates them: it takes places,
/// constants and limits from backend/cpp/placement.hpp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "device/sheet.hpp"

namespace edsc {

struct LoadedSheet {
  std::unique_ptr<const Sheet> sheet;  ///< null: the values do not fit into the address range of the tables
  std::vector<std::string> notes;      ///< what of the EDS a dynamic device does not have
};

[[nodiscard]] LoadedSheet load_sheet(const Device& device, const Options& options);

}  // namespace edsc
