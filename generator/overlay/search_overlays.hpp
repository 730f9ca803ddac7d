/// The overlays in the folders of EDSC_OVERLAYS, which apply to files by vendor, product and revision.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// The folders of the environment variable EDSC_OVERLAYS, separated as those of PATH.
[[nodiscard]] std::vector<std::string> overlay_folders();

/// The overlay in `folders` for the device of `file`: of several, the one that names the revision; null if there is
/// none. Two equal ones are an error, and a folder that cannot be read is one.
[[nodiscard]] std::shared_ptr<const SourceFile> find_overlay(const std::vector<std::string>& folders,
                                                             const std::shared_ptr<const SourceFile>& file,
                                                             Diagnostics& diagnostics);

}  // namespace edsc
