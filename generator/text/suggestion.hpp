/// Suggestions for an unknown word.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// The number of characters to add, remove, replace or swap with the next one that make `a` to `b`, ignoring letter
/// case; at most `most` + 1.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most);

/// Returns the candidate that differs from `word` by the fewest characters (added, missing, replaced, or two swapped),
/// ignoring letter case; the first of several. Empty if none is similar: words of up to four characters may have one
/// difference, longer words two.
[[nodiscard]] std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates);

/// Returns `; did you mean "check"?`, or nothing if no candidate is similar.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace edsc
