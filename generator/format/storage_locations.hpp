/// Comments of CANopenNode that say where a value is stored, as options of edsc.
#pragma once

#include <nlohmann/json.hpp>

#include "device/device.hpp"
#include "device/options/options.hpp"
#include "eds/ini.hpp"

namespace edsc {

/// Reads the comments `;StorageLocation=GROUP` in the sections of the entries and returns the options `storage` that
/// make the device store the same entries: RAM and ROM are not stored, another group is. A group whose name is a word
/// in the ParameterName of a sub-index of 1010h from 05h on is stored by that sub-index. Null: there are no comments.
[[nodiscard]] nlohmann::ordered_json storage_options(const IniFile& ini, const Device& device, const Options& options);

}  // namespace edsc
