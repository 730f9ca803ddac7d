/// Reads the lines or packets of a log.
#pragma once

#include "decode/log/log_line.hpp"

namespace edsc {

class LogSource {
 public:
  LogSource() = default;
  LogSource(const LogSource&) = delete;
  LogSource& operator=(const LogSource&) = delete;
  virtual ~LogSource() = default;

  /// The next line or packet, whose texts are valid until the next call. Returns false at the end and on a read error.
  [[nodiscard]] virtual bool next(LogLine& line) = 0;
};

/// Parses the lines of a text format, in their order.
class LineParser {
 public:
  LineParser() = default;
  LineParser(const LineParser&) = delete;
  LineParser& operator=(const LineParser&) = delete;
  virtual ~LineParser() = default;

  /// `text` has no line end. The texts of the result are valid until the next call, and as long as `text`.
  [[nodiscard]] virtual LogLine parse(std::string_view text) = 0;
};

}  // namespace edsc
