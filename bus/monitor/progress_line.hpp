/// How far a long work is: one line on standard error that is written again and again, on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace edsc {

/// Appears when the work has taken a while, and is gone with this.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is time to show something new.
  [[nodiscard]] bool due() const;
  void show(const std::string& text);
  /// Before something else is printed.
  void hide();

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  bool shown_ = false;
  Clock::time_point next_;
};

}  // namespace edsc
