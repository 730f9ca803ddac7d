#include "decode/formats/log_input.hpp"

#include <algorithm>
#include <cstring>

namespace edsc {
namespace {

constexpr std::string_view line_blanks = " \t\r\n", byte_order_mark = "\xEF\xBB\xBF";

/// Whether the first line that is not blank is complete, or the bytes are not text.
bool is_enough(std::string_view bytes) {
  const std::size_t begin = bytes.find_first_not_of(line_blanks);
  if (begin == std::string_view::npos) return false;
  return bytes.find('\n', begin) != std::string_view::npos || bytes.find('\0') != std::string_view::npos;
}

}  // namespace

std::size_t LogInput::fetch(char* to, std::size_t most) {
  if (at_end_) return 0;
  const std::ptrdiff_t count = read_(to, most);
  at_end_ = count <= 0;
  if (count < 0) error_ = static_cast<int>(-count);
  return at_end_ ? 0 : static_cast<std::size_t>(count);
}

std::string_view LogInput::beginning() {
  while (!at_end_ && beginning_.size() < max_beginning && !is_enough(beginning_)) {
    const std::size_t size = beginning_.size();
    beginning_.resize(max_beginning);
    beginning_.resize(size + fetch(beginning_.data() + size, max_beginning - size));
  }
  return beginning_;
}

std::size_t LogInput::read(char* to, std::size_t most) {
  std::size_t count = std::min(most, beginning_.size() - begin_);
  if (count > 0) {
    std::memcpy(to, beginning_.data() + begin_, count);
    begin_ += count;
  } else {
    count = fetch(to, most);
  }
  position_ += count;
  return count;
}

std::string_view first_line(std::string_view beginning) {
  if (beginning.starts_with(byte_order_mark)) beginning.remove_prefix(byte_order_mark.size());
  beginning.remove_prefix(std::min(beginning.find_first_not_of(line_blanks), beginning.size()));
  return beginning.substr(0, beginning.find_first_of("\r\n"));
}

}  // namespace edsc
