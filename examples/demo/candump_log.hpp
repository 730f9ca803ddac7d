/// The frames of a bus as `candump -L` writes them, for `edsc decode` and other tools.
#pragma once

#include <canopen/frame.hpp>
#include <canopen/time.hpp>
#include <cstdio>
#include <string>

namespace demo {

class CandumpLog {
 public:
  CandumpLog() = default;
  CandumpLog(const CandumpLog&) = delete;
  CandumpLog& operator=(const CandumpLog&) = delete;
  ~CandumpLog();

  /// False: the file cannot be written.
  [[nodiscard]] bool open(const std::string& path);

  /// Does nothing while no file is open.
  void write(const canopen::Frame& frame, canopen::TimePoint now);

  /// False: something could not be written.
  [[nodiscard]] bool close();

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace demo
