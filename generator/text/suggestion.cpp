#include "text/suggestion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "text/ascii.hpp"

namespace edsc {
namespace {

constexpr std::size_t max_length = 64;

std::size_t max_distance(std::size_t length) {
  if (length < 3) return 0;
  return length <= 4 ? 1 : 2;
}

}  // namespace

/// Optimal string alignment.
std::size_t edit_distance(std::string_view a, std::string_view b, std::size_t most) {
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > most) return most + 1;
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool equal = to_lower(a[i - 1]) == to_lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (equal ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && to_lower(a[i - 1]) == to_lower(b[j - 2]) && to_lower(a[i - 2]) == to_lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return std::min(last[b.size()], most + 1);
}

std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates) {
  const std::size_t limit = max_distance(word.size());
  std::string_view best;
  std::size_t best_distance = limit + 1;
  for (const std::string_view candidate : candidates) {
    if (best_distance == 0 || word.size() > max_length || candidate.size() > max_length) continue;
    const std::size_t found = edit_distance(word, candidate, best_distance - 1);
    if (found < best_distance) std::tie(best, best_distance) = std::pair{candidate, found};
  }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view similar = most_similar(word, candidates);
  return similar.empty() ? std::string{} : fmt::format("; did you mean \"{}\"?", similar);
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  return did_you_mean(word, std::vector<std::string_view>{candidates.begin(), candidates.end()});
}

}  // namespace edsc
