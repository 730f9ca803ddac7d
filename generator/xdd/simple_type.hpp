/// The simple data types of CiA 311 (those of IEC 61131-3) and the corresponding data types of CiA 301.
#pragma once

#include <string_view>

namespace edsc {

struct SimpleType {
  std::string_view name;
  std::string_view data_type;  ///< in EDS spelling
};

/// Null if the name of the element is not a simple type.
[[nodiscard]] const SimpleType* find_simple_type(std::string_view name);

/// For BITSTRING without a value, which tools write for DOMAIN, as CiA 311 does not define it.
[[nodiscard]] const SimpleType& domain_type();

inline constexpr std::string_view bit_string = "BITSTRING";

}  // namespace edsc
