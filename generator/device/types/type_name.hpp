/// Data types by name, for messages: an EDS names them by number.
#pragma once

#include <canopen/od/data_type.hpp>
#include <string_view>

namespace edsc {

/// Finds a data type by its name in CiA 301 or a usual programming language (`UNSIGNED8`, `uint8_t`, `float`), ignoring
/// letter case. Null if unknown.
[[nodiscard]] const canopen::DataTypeRow* find_type_by_name(std::string_view name);

}  // namespace edsc
