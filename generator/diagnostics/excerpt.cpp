#include "diagnostics/excerpt.hpp"

#include <algorithm>

#include "text/utf8.hpp"

namespace edsc {
namespace {

constexpr std::string_view cut_mark = "...";

/// Steps up to `most` code points back from `at`; gives how many there were.
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

/// ASCII below blank, DEL, and U+0080..U+009F, which in UTF-8 are C2h and a byte below A0h.
bool begins_with_control(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  const bool is_c1 = first == 0xC2 && text.size() > 1 && static_cast<unsigned char>(text[1]) < 0xA0;
  return first < 0x20 || first == 0x7F || is_c1;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    std::size_t length = 0;
    step_forward(text, length, 1);
    if (text[0] == '\t') {
      result += ' ';
    } else if (begins_with_control(text)) {
      result += '?';
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(length);
  }
  return result;
}

Excerpt excerpt(std::string_view line, const Position& position) {
  constexpr std::size_t columns = Excerpt::most_columns - 2 * cut_mark.size();
  const std::size_t caret = std::min<std::size_t>(position.column == 0 ? 0 : position.column - 1, line.size());

  // Half of the window before the caret, the rest behind it, and what the rest leaves over before it again.
  std::size_t begin = caret;
  std::size_t end = caret;
  std::size_t before = step_back(line, begin, columns / 2);
  const std::size_t after = step_forward(line, end, columns - before);
  before += step_back(line, begin, columns - before - after);

  Excerpt result;
  result.text = printable(line.substr(begin, end - begin));
  result.caret = before;
  const std::size_t underlined = std::min<std::size_t>(position.length, end - caret);
  result.caret_columns = std::max<std::size_t>(count_code_points(line.substr(caret, underlined)), 1);
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
