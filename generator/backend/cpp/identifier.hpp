/// C++ identifiers from names of the EDS.
#pragma once

#include <string>
#include <string_view>

namespace edsc {

/// The name in snake_case; a word that C++ or the generated code reserves gets a trailing underscore: `Switch` ->
/// `switch_`.
[[nodiscard]] std::string to_cpp_identifier(std::string_view name);

/// The same for a name that already is in snake_case.
[[nodiscard]] std::string without_reserved_word(std::string identifier);

/// The same for the name of a value or field, which may be that of a member of an object: `index`.
[[nodiscard]] std::string without_keyword(std::string identifier);

/// Whether the name is valid for an object: not empty, snake_case and not reserved.
[[nodiscard]] bool is_identifier(std::string_view name);

/// The identifier for a namespace at global scope, which must differ from functions of the C library and names in the
/// generated tables: `signal` -> `signal_`. "device" if nothing remains.
[[nodiscard]] std::string to_namespace(std::string_view name);

/// `tpdo_communication_parameter` -> `TpdoCommunicationParameter`.
[[nodiscard]] std::string to_camel_case(std::string_view snake_case);

}  // namespace edsc
