/// Signals that end a command where it waits.
#pragma once

#include <signal.h>

#include <csignal>
#include <cstdint>
#include <initializer_list>

namespace edsc {

/// Records these signals, which are delivered only while the command waits with `while_waiting`, as in ppoll().
class WaitingSignals {
 public:
  /// What the second signal of a kind does.
  enum class Second : std::uint8_t { is_recorded, ends_program };

  WaitingSignals(std::initializer_list<int> signals, Second second);

  [[nodiscard]] static bool noted() { return noted_ != 0; }
  [[nodiscard]] const sigset_t* while_waiting() const { return &while_waiting_; }

 private:
  inline static volatile std::sig_atomic_t noted_ = 0;
  sigset_t while_waiting_{};
};

}  // namespace edsc
