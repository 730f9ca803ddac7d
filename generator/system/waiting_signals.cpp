#include "system/waiting_signals.hpp"

namespace edsc {

void WaitingSignals::note(int /*signal*/) { noted_ = 1; }

WaitingSignals::WaitingSignals(std::initializer_list<int> signals, Second second) {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = second == Second::ends_program ? static_cast<int>(SA_RESETHAND) : 0;
  sigset_t blocked{};
  sigemptyset(&blocked);
  for (const int signal : signals) {
    sigaction(signal, &action, nullptr);
    sigaddset(&blocked, signal);
  }
  sigprocmask(SIG_BLOCK, &blocked, &while_waiting_);
  for (const int signal : signals) sigdelset(&while_waiting_, signal);
}

}  // namespace edsc
