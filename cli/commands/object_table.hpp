/// `edsc object import` and `edsc object export`: objects as a CSV file.
#pragma once

#include "commands/commands.hpp"

namespace edsc {

AddOptions add_object_import_options;
AddOptions add_object_export_options;

}  // namespace edsc
