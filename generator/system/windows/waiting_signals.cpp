#include "system/waiting_signals.hpp"

#include <csignal>

#include "system/windows/cancelled_read.hpp"

namespace edsc {
namespace {

bool is_recorded_again = false;

}  // namespace

void WaitingSignals::note(int signal) {
  noted_ = 1;
  if (is_recorded_again) std::signal(signal, note);  // Windows has reset it
  cancel_reads();
}

WaitingSignals::WaitingSignals(std::initializer_list<int> signals, Second second) {
  is_recorded_again = second == Second::is_recorded;
  for (const int signal : signals) std::signal(signal, note);
}

}  // namespace edsc
