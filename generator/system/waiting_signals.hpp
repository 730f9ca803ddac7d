/// Signals that end a command where it waits.
#pragma once

#include <signal.h>

#include <csignal>
#include <cstdint>
#include <initializer_list>

namespace edsc {

#ifdef _WIN32
using SignalMask = int;  ///< unused: Windows delivers signals in a thread of their own
#else
using SignalMask = sigset_t;
#endif

/// Records these signals. On Linux they are delivered only while the command waits with `while_waiting`, as in ppoll().
class WaitingSignals {
 public:
  /// What the second signal of a kind does.
  enum class Second : std::uint8_t { is_recorded, ends_program };

  WaitingSignals(std::initializer_list<int> signals, Second second);

  [[nodiscard]] static bool noted() { return noted_ != 0; }
  [[nodiscard]] const SignalMask* while_waiting() const { return &while_waiting_; }

 private:
  static void note(int signal);

  inline static volatile std::sig_atomic_t noted_ = 0;
  SignalMask while_waiting_{};
};

}  // namespace edsc
