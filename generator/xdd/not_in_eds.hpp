/// What an XDD says and an EDS cannot express.
#pragma once

#include <string>
#include <vector>

#include "diagnostics/diagnostics.hpp"

namespace edsc {

/// An element or attribute, such as `DeviceIdentity/deviceFamily`, at the first place where the file has it.
struct NotInEds {
  Position position;
  std::string what;
};

}  // namespace edsc
