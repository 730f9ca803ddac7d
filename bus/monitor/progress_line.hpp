/// A progress line on standard error, which is rewritten repeatedly; on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace edsc {

/// Appears if the work takes a while, and disappears with this object.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is time for an update.
  [[nodiscard]] bool due() const;
  void show(const std::string& text);
  /// Shows the first text of work that is known to take a while, without waiting for an update.
  void show_at_once(const std::string& text);
  /// Removes the line before other output.
  void hide();

 private:
  using Clock = std::chrono::steady_clock;

  bool terminal_;
  bool shown_ = false;
  Clock::time_point next_;
};

}  // namespace edsc
