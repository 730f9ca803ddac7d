/// Changes as text for people, and as JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/change.hpp"

namespace edsc {

/// A line for each change, as compilers write them, and a summary.
[[nodiscard]] std::string changes_as_text(const Changes& changes, bool colour);

/// `{"version": 1, "changes": [...], "breaking": n, "compatible": n}`: docs/command-line.md.
[[nodiscard]] nlohmann::ordered_json changes_as_json(const Changes& changes);

}  // namespace edsc
