#include "diagnostics/excerpt.hpp"

#include <algorithm>

#include "text/printable.hpp"
#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::string_view cut_mark = "...";

/// Steps up to `most` code points back from `at`, and returns their number.
std::size_t step_back(std::string_view text, std::size_t& at, std::size_t most) {
  std::size_t steps = 0;
  while (at > 0 && steps < most) {
    do {
      --at;
    } while (at > 0 && is_utf8_continuation(text[at]));
    ++steps;
  }
  return steps;
}

std::size_t step_forward(std::string_view text, std::size_t& at, std::size_t most) {
  std::size_t steps = 0;
  while (at < text.size() && steps < most) {
    do {
      ++at;
    } while (at < text.size() && is_utf8_continuation(text[at]));
    ++steps;
  }
  return steps;
}

}  // namespace

Excerpt excerpt(std::string_view line, const Position& position) {
  constexpr std::size_t columns = Excerpt::max_columns - 2 * cut_mark.size();
  const std::size_t caret = std::min<std::size_t>(position.column == 0 ? 0 : position.column - 1, line.size());

  // Half of the window before the caret, the rest after it, and unused columns before it again.
  std::size_t begin = caret;
  std::size_t end = caret;
  const std::size_t before = step_back(line, begin, columns / 2);
  const std::size_t after = step_forward(line, end, columns - before);
  step_back(line, begin, columns - before - after);

  Excerpt result;
  result.text = printable(line.substr(begin, end - begin));
  result.caret = count_code_points(printable(line.substr(begin, caret - begin)));
  const std::size_t underlined = std::min<std::size_t>(position.length, end - caret);
  result.caret_columns = std::max<std::size_t>(count_code_points(printable(line.substr(caret, underlined))), 1);
  if (begin > 0) {
    result.text.insert(0, cut_mark);
    result.caret += cut_mark.size();
  }
  if (end < line.size()) {
    result.text += cut_mark;
  }
  return result;
}

}  // namespace edsc
