/// Writes the frames of a bus as a candump log.
#pragma once

#include <canopen/base/clock.hpp>
#include <canopen/can/frame.hpp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace edsc {

class FrameLog {
 public:
  /// `path`: emptied; empty: standard output. `interface`: of each line. Ends the command if the file cannot be opened.
  FrameLog(const std::string& path, std::string interface);

  /// A frame that was received or sent at this time. Returns false if the file cannot be written.
  [[nodiscard]] bool write(const canopen::Frame& frame, canopen::TimePoint at, canopen::TimePoint now);
  [[nodiscard]] bool flush() { return std::fflush(file_) == 0; }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::unique_ptr<std::FILE, Close> own_;
  std::FILE* file_ = stdout;
  std::string interface_;
  std::int64_t last_us_ = 0;  ///< the time of day of the previous frame
  std::uint64_t frames_ = 0;
};

}  // namespace edsc
