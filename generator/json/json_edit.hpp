/// Edits of a JSON text that keep all other bytes: comments, blanks, line ends and the order of members.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "json/json_ranges.hpp"

namespace edsc {

/// A text is JSON, as JsonFile says; so is the result. There is none if the text does not have the value at the path,
/// or for a new value its object or array.

/// Replaces a value, or adds it as the last member of its object, or as the last element of its array, whose number is
/// then `-`. The value has the style of the others: on one line or on several, its indent, the blanks after a colon.
/// New lines take the line end of the line before.
[[nodiscard]] std::optional<std::string> with_json_value(std::string_view text, const JsonPath& path,
                                                         const nlohmann::ordered_json& value);

/// Removes a member or an element with its comma. If it is alone on its lines, they are removed, with a comment after
/// it; comments on the lines before remain.
[[nodiscard]] std::optional<std::string> without_json_value(std::string_view text, const JsonPath& path);

/// Gives a member another name.
[[nodiscard]] std::optional<std::string> with_json_name(std::string_view text, const JsonPath& path,
                                                        std::string_view name);

/// Moves a member or an element to place `to` among its siblings, from 0, with the comment lines before it and the
/// comment after it.
[[nodiscard]] std::optional<std::string> with_json_moved(std::string_view text, const JsonPath& path, std::size_t to);

}  // namespace edsc
