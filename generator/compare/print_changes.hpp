/// Changes as text and Markdown for people, and as JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "compare/change.hpp"

namespace edsc {

/// `drive.eds:12`; the file alone if the position is the whole file.
[[nodiscard]] std::string text_of_place(const Position& position);
/// `{"file", "line", "column"}`
[[nodiscard]] nlohmann::ordered_json json_of_place(const Position& position);

/// `breaks master and PDO partner`, or `compatible`.
[[nodiscard]] std::string verdict_text(const Change& change);

/// A line for each change, in the format of compiler messages, and a summary.
[[nodiscard]] std::string changes_as_text(const Changes& changes, bool colour);

/// A heading, a table of the breaking changes and one of the others, folded: for a comment on a pull request.
[[nodiscard]] std::string changes_as_markdown(const Changes& changes, std::string_view before, std::string_view after);

/// The heading of a file that is new.
[[nodiscard]] std::string new_file_as_markdown(std::string_view name);

/// `{"schema": 2, "changes": [...], "breaking": n, "compatible": n}`: docs/command-line.md.
[[nodiscard]] nlohmann::ordered_json changes_as_json(const Changes& changes);

}  // namespace edsc
