/// Suggestions for an unknown word.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// Returns the candidate that differs from `word` by the fewest characters (added, missing, replaced, or two swapped),
/// ignoring letter case; the first of several. Empty if none is similar: words of up to four characters may have one
/// difference, longer words two.
[[nodiscard]] std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates);

/// Returns `; did you mean "check"?`, or nothing if no candidate is similar.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace edsc
