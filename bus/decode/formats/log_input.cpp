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
  while (!at_end_ && end_ < buffer_size && !is_enough({buffer_.data(), end_})) {
    end_ += fetch(buffer_.data() + end_, buffer_size - end_);
  }
  return {buffer_.data() + begin_, end_ - begin_};
}

std::size_t LogInput::read(char* to, std::size_t most) {
  std::size_t count = 0;
  if (begin_ == end_ && most >= buffer_size) {
    count = fetch(to, most);
  } else {
    if (begin_ == end_) {
      begin_ = 0;
      end_ = fetch(buffer_.data(), buffer_size);
    }
    count = std::min(most, end_ - begin_);
    std::memcpy(to, buffer_.data() + begin_, count);
    begin_ += count;
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
