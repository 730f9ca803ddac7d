#include "device/reserved_values.hpp"

#include <algorithm>
#include <canopen/pdo/pdo_parameters.hpp>

#include "device/index_range.hpp"
#include "device/pdo/pdo_defaults.hpp"

namespace edsc {
namespace {

bool is_reserved_type(bool receives, std::uint64_t type) {
  return !canopen::transmission_type_is_legal(receives, static_cast<std::uint32_t>(std::min<std::uint64_t>(type, 256)));
}

struct ReservedValue {
  IndexRange indices;
  std::uint8_t sub_index;
  bool (*is_reserved)(std::uint64_t value);
  std::string_view why;
};

constexpr ReservedValue reserved_values[] = {
    {{0x1400, 0x15FF},
     transmission_type_sub_index,
     [](std::uint64_t value) { return is_reserved_type(true, value); },
     "241 to 253 are reserved for an RPDO (CiA 301, 7.5.2.35)"},
    {{0x1800, 0x19FF},
     transmission_type_sub_index,
     [](std::uint64_t value) { return is_reserved_type(false, value); },
     "241 to 251 are reserved (CiA 301, 7.5.2.37)"},
    {{0x1019, 0x1019},
     0,
     [](std::uint64_t value) { return value == 1 || value > 240; },
     "1 and the values above 240 are reserved (CiA 301, 7.5.2.22)"},
};

}  // namespace

std::string_view why_reserved(std::uint16_t index, std::uint8_t sub_index, std::uint64_t value) {
  const auto row = std::ranges::find_if(reserved_values, [&](const ReservedValue& one) {
    return index >= one.indices.first && index <= one.indices.last && sub_index == one.sub_index &&
           one.is_reserved(value);
  });
  return row == std::end(reserved_values) ? std::string_view{} : row->why;
}

}  // namespace edsc
