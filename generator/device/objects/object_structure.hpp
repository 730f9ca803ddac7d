/// Sub-index FFh, which describes the structure of its object (CiA 301, 7.4.4).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/device.hpp"

namespace edsc {

inline constexpr std::uint8_t structure_sub_index = 0xFF;

/// The value of sub-index FFh: the object code in bits 0 to 7, the data type in bits 8 to 15, 0 above.
struct ObjectStructure {
  std::uint8_t object_code = 0;
  std::optional<std::uint8_t> data_type;  ///< nothing for a RECORD of the manufacturer or of a profile

  [[nodiscard]] bool matches(std::uint64_t value) const;
  [[nodiscard]] std::string text() const;  ///< `object code 08h and data type 05h`
};

[[nodiscard]] ObjectStructure structure_of(const Object& object);

}  // namespace edsc
