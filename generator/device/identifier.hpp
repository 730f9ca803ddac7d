/// Names of the data sheet as C++ identifiers.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>

namespace edsc {

/// `Position actual value` -> `position_actual_value`, `COB-ID SYNC` -> `cob_id_sync`, `NrOfRxPDO` -> `nr_of_rx_pdo`.
/// Letters beyond ASCII are written out where that is usual (ae for a-umlaut, u for micro) and left out otherwise. Words of
/// C++ get a trailing underscore. Empty when nothing is left.
[[nodiscard]] std::string to_snake_case(std::string_view name);

/// Whether an object can be called so: not empty, snake_case and no word of C++.
[[nodiscard]] bool is_identifier(std::string_view name);

/// The same for a namespace at global scope, which functions of the C library and the words of the generated tables share:
/// `signal` -> `signal_`. "device" when nothing is left.
[[nodiscard]] std::string to_namespace(std::string_view name);

/// `tpdo_communication_parameter` -> `TpdoCommunicationParameter`.
[[nodiscard]] std::string to_camel_case(std::string_view snake_case);

/// Identifiers that are taken in one scope.
class IdentifierScope {
 public:
  /// Takes `wanted`, or the first free one of `wanted` + `suffix`, `wanted` + `suffix` + `_2`, ...
  [[nodiscard]] std::string take(const std::string& wanted, std::string_view suffix);

 private:
  std::unordered_set<std::string> taken_;
};

}  // namespace edsc
