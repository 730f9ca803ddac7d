/// Writes the frames of a bus in the format of `candump -L`, for `edsc decode` and other tools.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdio>
#include <string>

namespace demo {

class CandumpLog {
 public:
  CandumpLog() = default;
  CandumpLog(const CandumpLog&) = delete;
  CandumpLog& operator=(const CandumpLog&) = delete;
  ~CandumpLog();

  /// Returns false if the file cannot be written.
  [[nodiscard]] bool open(const std::string& path);

  /// Does nothing if no file is open.
  void write(const canopen::Frame& frame, canopen::TimePoint now);

  /// Returns false if the file was not written completely.
  [[nodiscard]] bool close();

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace demo
