/// Data types by name, for messages: an EDS names them by number.
#pragma once

#include <canopen/data_type.hpp>
#include <string_view>

namespace edsc {

/// The type that CiA 301 or a usual programming language calls so (`UNSIGNED8`, `uint8_t`, `float`), letter case ignored;
/// null for any other word.
[[nodiscard]] const canopen::DataTypeRow* find_type_by_name(std::string_view name);

}  // namespace edsc
