/// The lines of a file, pipe or terminal, as soon as they are there.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace edsc {

class LogReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{64} * 1024;

  /// `before_reading` is called when no whole line is left: now is the time to show what there is. False: the log is to
  /// end here.
  LogReader(int file_descriptor, std::function<bool()> before_reading);

  /// The next line without its line end; it stands until the next call. What is longer than `longest_line` is cut.
  /// False at the end, and when reading fails.
  [[nodiscard]] bool next(std::string_view& line);

  /// Number of the line, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  /// errno of what went wrong; 0: nothing did.
  [[nodiscard]] int error() const { return error_; }

 private:
  [[nodiscard]] bool fill();

  int file_descriptor_;
  std::function<bool()> before_reading_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of what has not been handed out
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool in_piece_ = false;  ///< of a line that has been cut
  bool at_end_ = false;
  int error_ = 0;
};

}  // namespace edsc
