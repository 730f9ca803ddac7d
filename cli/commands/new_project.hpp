/// The files of a project beside a new EDS: build, application, programs and options.
#pragma once

#include <string>
#include <vector>

#include "change/new_sheet.hpp"
#include "change/open_sheet.hpp"
#include "system/write_files.hpp"

namespace edsc {

/// Why a file of this name cannot have a project; empty if it can.
[[nodiscard]] std::string project_name_fault(const std::string& path);

/// The files of a project for the EDS `path`, in its folder. `sheet` describes the device, `open` is the EDS that it
/// has become.
[[nodiscard]] std::vector<OutputFile> project_files(const std::string& path, const NewSheet& sheet,
                                                    const OpenSheet& open);

}  // namespace edsc
