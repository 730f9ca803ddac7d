/// The changes that the page of `edsc edit` requests.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "change/change.hpp"
#include "change/open_sheet.hpp"
#include "text/source_file.hpp"

namespace edsc::edit {

struct RequestedChanges {
  std::vector<SheetChange> changes;
  std::vector<std::size_t> requests;  ///< of each change: its place in the request
  std::string problem;                ///< why a request is not possible
  std::size_t problem_at = 0;         ///< its place
};

/// Reads a list of requests: the changes of `change.hpp`, with data types by name and `""` as removal, and `pdo` and
/// `new`, whose values are texts as people write them. `imported`: the text of another file, or null.
[[nodiscard]] RequestedChanges read_requests(const nlohmann::json& list, const OpenSheet& sheet,
                                             const SourceFile* imported);

}  // namespace edsc::edit
