/// A profile in the syntax of an EDS: the profile database of a user (CiA 306-2).
#pragma once

#include <memory>
#include <string>

#include "device/meaning/profiles.hpp"
#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

struct UserProfile {
  std::unique_ptr<SourceFile> source;
  bool is_readable = true;
  MeaningProfile profile;  ///< its number is that of 1000h; 0: the rows apply to each device
};

/// Reads the objects of a profile database; those below 2000h are not of a profile. Its access types say who gives an
/// object its value: `rww` and `wo` a master, `ro` the device, `const` the manufacturer, `rw` and `rwr` whoever
/// configures the device. A file without such objects is an error.
[[nodiscard]] UserProfile read_user_profile(const std::string& path, Diagnostics& diagnostics);

}  // namespace edsc
