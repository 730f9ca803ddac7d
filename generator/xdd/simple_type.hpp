/// The simple data types of CiA 311 (those of IEC 61131-3), and the data types of CiA 301 that they are.
#pragma once

#include <string_view>

namespace edsc {

struct SimpleType {
  std::string_view name;
  std::string_view data_type;  ///< as an EDS spells it
};

/// Null when the element's name is no simple type.
[[nodiscard]] const SimpleType* find_simple_type(std::string_view name);

/// BITSTRING without a value. CiA 311 has no DOMAIN; tools write it like that.
[[nodiscard]] const SimpleType& domain_type();

inline constexpr std::string_view bit_string = "BITSTRING";

}  // namespace edsc
