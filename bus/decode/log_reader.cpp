#include "decode/log_reader.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace edsc {

LogReader::LogReader(int file_descriptor, std::function<bool()> before_reading)
    : file_descriptor_{file_descriptor}, before_reading_{std::move(before_reading)}, buffer_(2 * longest_line, '\0') {}

/// Reads more bytes after the incomplete line. Returns false at the end.
bool LogReader::fill() {
  if (at_end_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  at_end_ = !before_reading_();
  if (at_end_) return false;
  ssize_t count = 0;
  do {
    count = ::read(file_descriptor_, buffer_.data() + end_, buffer_.size() - end_);
  } while (count < 0 && errno == EINTR);
  if (count < 0) error_ = errno;
  at_end_ = count <= 0;
  if (!at_end_) end_ += static_cast<std::size_t>(count);
  return !at_end_;
}

bool LogReader::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    const char* const begin = buffer_.data() + begin_;
    const std::size_t size = end_ - begin_;
    const void* const found = std::memchr(begin + searched, '\n', size - searched);
    const bool too_long = found == nullptr && size >= longest_line;
    if (found != nullptr || too_long) {
      const std::size_t length =
          found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - begin) : size;
      line = {begin, length};
      begin_ += length + (found != nullptr ? 1 : 0);
      if (std::exchange(in_piece_, too_long)) {
        searched = 0;
        continue;
      }
      ++line_number_;
      return true;
    }
    searched = size;
    if (fill()) continue;
    if (begin_ == end_) return false;
    line = {buffer_.data() + begin_, end_ - begin_};
    begin_ = end_;
    if (std::exchange(in_piece_, false)) return false;
    ++line_number_;
    return true;
  }
}

}  // namespace edsc
