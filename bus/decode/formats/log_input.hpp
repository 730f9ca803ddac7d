/// The bytes of a log, which come from a file, a pipe, a terminal or memory.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace edsc {

class LogInput {
 public:
  /// Bytes that are read ahead, if they are available; maximum length of the beginning.
  static constexpr std::size_t buffer_size = std::size_t{64} * 1024;

  /// Stores 1 to `most` bytes at `to` and returns their number; 0: the end; negative: -errno.
  using Read = std::function<std::ptrdiff_t(char* to, std::size_t most)>;

  explicit LogInput(Read read) : read_{std::move(read)}, buffer_(buffer_size, '\0') {}

  /// The bytes up to the end of the first line that is not blank, which show the format; more, if more are available.
  /// They remain in the input. Call it before read().
  [[nodiscard]] std::string_view beginning();

  /// Stores 1 to `most` bytes at `to` and returns their number; 0: the end, or an error.
  [[nodiscard]] std::size_t read(char* to, std::size_t most);

  /// Number of bytes that have been read.
  [[nodiscard]] std::uint64_t position() const { return position_; }
  /// errno of the read error; 0: none.
  [[nodiscard]] int error() const { return error_; }

 private:
  [[nodiscard]] std::size_t fetch(char* to, std::size_t most);

  Read read_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< of the unread bytes in the buffer
  std::uint64_t position_ = 0;
  bool at_end_ = false;
  int error_ = 0;
};

/// The first line that is not blank, without blanks before it and without a byte order mark.
[[nodiscard]] std::string_view first_line(std::string_view beginning);

}  // namespace edsc
