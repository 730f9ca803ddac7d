/// The changes of a network file that the page of `edsc edit` requests.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace edsc::edit {

struct ChangedNetwork {
  std::string text;
  std::string name;  ///< of the step: `set node_id of axis1 to 5`
  bool is_renamed = false;
  std::string problem;         ///< why a request is not possible; then the text is not changed
  std::size_t problem_at = 0;  ///< its place in the list
};

/// Makes the first `count` requests of a list in the text of a network file, which is a JSON object. Each is `set`,
/// `add`, `remove`, `rename` or `move` at a JSON pointer, with values as the texts of a form.
[[nodiscard]] ChangedNetwork change_network(std::string_view text, const nlohmann::json& list, std::size_t count);

}  // namespace edsc::edit
