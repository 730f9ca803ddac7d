/// A value of an entry, with its place in the EDS.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "diagnostics/position.hpp"

namespace edsc {

/// A value of the EDS. Numbers are stored as the bits of their type: two's complement extended to 64 bits, or the IEEE
/// 754 pattern.
struct Value {
  std::uint64_t bits = 0;
  bool plus_node_id = false;     ///< the node-ID must be added when it is known
  bool hexadecimal = false;      ///< as written in the EDS
  std::string bytes = {};        ///< of strings
  Position position = {};        ///< in the file; of its section if the value is missing
  std::string_view clause = {};  ///< of CiA 301, if the value comes from there; otherwise empty
};

}  // namespace edsc
