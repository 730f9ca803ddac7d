/// Parts of an XDD that an EDS cannot express.
#pragma once

#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// An element or attribute, such as `DeviceIdentity/deviceFamily`, at its first position in the file.
struct NotInEds {
  Position position;
  std::string what;
};

}  // namespace edsc
