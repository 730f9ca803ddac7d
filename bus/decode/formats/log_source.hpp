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

}  // namespace edsc
