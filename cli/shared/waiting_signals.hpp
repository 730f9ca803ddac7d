/// Signals that end a command where it waits.
#pragma once

#include <signal.h>

#include <csignal>
#include <initializer_list>

namespace edsc {

/// Records these signals, which are delivered only while the command waits with `while_waiting`, as in ppoll().
class WaitingSignals {
 public:
  /// `flags` of sigaction()
  WaitingSignals(std::initializer_list<int> signals, int flags) {
    struct sigaction action {};
    action.sa_handler = [](int) { noted_ = 1; };
    action.sa_flags = flags;
    sigset_t blocked{};
    sigemptyset(&blocked);
    for (const int signal : signals) {
      sigaction(signal, &action, nullptr);
      sigaddset(&blocked, signal);
    }
    sigprocmask(SIG_BLOCK, &blocked, &while_waiting_);
    for (const int signal : signals) sigdelset(&while_waiting_, signal);
  }

  [[nodiscard]] static bool noted() { return noted_ != 0; }
  [[nodiscard]] const sigset_t* while_waiting() const { return &while_waiting_; }

 private:
  inline static volatile std::sig_atomic_t noted_ = 0;
  sigset_t while_waiting_{};
};

}  // namespace edsc
