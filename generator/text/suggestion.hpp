/// What somebody may have meant who wrote a word that is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// The candidate that differs from `word` by the fewest characters (added, missing, replaced, or two swapped), letter
/// case ignored; the first one of several. Empty when none is similar: up to four characters may have one such
/// difference, longer words two.
[[nodiscard]] std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates);

/// `; did you mean "check"?`, or nothing when no candidate is similar.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace edsc
