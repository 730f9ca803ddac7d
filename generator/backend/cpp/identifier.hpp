/// C++ identifiers from names of the EDS.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace edsc {

/// `Position actual value` -> `position_actual_value`, `COB-ID SYNC` -> `cob_id_sync`, `NrOfRxPDO` -> `nr_of_rx_pdo`.
/// Non-ASCII letters are transliterated if usual (ae for a-umlaut, u for micro) and omitted otherwise. C++ keywords get
/// a trailing underscore. Empty if nothing remains.
[[nodiscard]] std::string to_snake_case(std::string_view name);

/// Whether the name is valid for an object: not empty, snake_case and not a C++ keyword.
[[nodiscard]] bool is_identifier(std::string_view name);

/// The same for a namespace at global scope, which must differ from functions of the C library and names in the
/// generated tables: `signal` -> `signal_`. "device" if nothing remains.
[[nodiscard]] std::string to_namespace(std::string_view name);

/// `tpdo_communication_parameter` -> `TpdoCommunicationParameter`.
[[nodiscard]] std::string to_camel_case(std::string_view snake_case);

/// The identifiers in use in one scope.
class IdentifierScope {
 public:
  /// Reserves `wanted`, or the first free one of `wanted` + `suffix`, `wanted` + `suffix` + `_2`, ...
  [[nodiscard]] std::string take(const std::string& wanted, std::string_view suffix);

 private:
  std::unordered_set<std::string> taken_;
};

}  // namespace edsc
