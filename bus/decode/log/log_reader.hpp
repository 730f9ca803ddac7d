/// Reads the lines of a file, pipe or terminal as soon as they are available.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace edsc {

class LogReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{64} * 1024;

  /// `before_reading` is called before waiting for input, when no complete line is left, to flush output. False: stop
  /// reading.
  LogReader(int file_descriptor, std::function<bool()> before_reading);

  /// The next line without its line end, valid until the next call; truncated to `longest_line`. Returns false at the
  /// end and on a read error.
  [[nodiscard]] bool next(std::string_view& line);

  /// Number of the line, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  /// errno of the read error; 0: none.
  [[nodiscard]] int error() const { return error_; }

 private:
  [[nodiscard]] bool fill();

  int file_descriptor_;
  std::function<bool()> before_reading_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool in_piece_ = false;  ///< of a truncated line
  bool at_end_ = false;
  int error_ = 0;
};

}  // namespace edsc
