#include "decode/log/log_reader.hpp"

#include <cstring>
#include <utility>

namespace edsc {

LogReader::LogReader(LogInput& input) : input_{input}, buffer_(2 * longest_line, '\0') {}

/// Reads more bytes after the incomplete line. Returns false at the end.
bool LogReader::fill() {
  if (at_end_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count = input_.read(buffer_.data() + end_, buffer_.size() - end_);
  end_ += count;
  at_end_ = count == 0;
  return !at_end_;
}

bool LogReader::next(std::string_view& line) {
  for (std::size_t searched = 0;;) {
    const std::string_view unread{buffer_.data() + begin_, end_ - begin_};
    const std::size_t end = unread.find('\n', searched);
    const bool has_end = end != std::string_view::npos, too_long = !has_end && unread.size() >= longest_line;
    searched = unread.size();
    if (!has_end && !too_long && fill()) continue;
    line = {buffer_.data() + begin_, has_end ? end : end_ - begin_};
    if (!has_end && line.empty()) return false;
    begin_ += line.size() + (has_end ? 1 : 0);
    searched = 0;
    if (std::exchange(in_piece_, too_long)) continue;
    ++line_number_;
    return true;
  }
}

}  // namespace edsc
