#include "diagnostics/quote.hpp"

#include <cstddef>

#include "text/utf8.hpp"

namespace edsc {

std::string quote(std::string_view text) {
  constexpr std::size_t most = 60;
  std::string result = "\"";
  if (text.size() <= most) {
    result += text;
  } else {
    std::size_t end = most;
    while (end > 0 && is_utf8_continuation(text[end])) {
      --end;
    }
    result += text.substr(0, end);
    result += "...";
  }
  result += '"';
  return result;
}

}  // namespace edsc
