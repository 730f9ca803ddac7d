/// Reads the lines of a log as soon as they are available.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "decode/formats/log_input.hpp"

namespace edsc {

class LogReader {
 public:
  static constexpr std::size_t longest_line = std::size_t{64} * 1024;

  /// `input` must outlive the reader.
  explicit LogReader(LogInput& input);

  /// The next line without its line end, valid until the next call; truncated to `longest_line`. Returns false at the
  /// end and on a read error.
  [[nodiscard]] bool next(std::string_view& line);

  /// Number of the line, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_number_; }

 private:
  [[nodiscard]] bool fill();

  LogInput& input_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool in_piece_ = false;  ///< of a truncated line
  bool at_end_ = false;
};

}  // namespace edsc
