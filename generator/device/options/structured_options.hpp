/// Options with a form of their own: lists, and objects by entry.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "device/options/option_file.hpp"
#include "device/options/option_table.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// Reads the value of an option whose row has the form `structured`; `path` is where the file has it. Reports invalid
/// values, which are ignored.
void read_structured_option(const OptionRow& row, const std::string& path, const nlohmann::json& value,
                            NameCheck is_name, OptionFile& file, Options& options);

}  // namespace edsc
