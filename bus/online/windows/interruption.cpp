#include "online/interruption.hpp"

#include <csignal>

namespace edsc {
namespace {

volatile std::sig_atomic_t noted_signal = 0;
int uninterrupted = 0;  ///< number of Uninterrupted objects

// Windows resets the handler of a signal before it calls it, so that the second one ends the program.
void note(int signal) { noted_signal = signal; }

}  // namespace

Interruption::Interruption() {
  noted_signal = 0;
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

Interruption::~Interruption() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

bool Interruption::noted() { return noted_signal != 0 && uninterrupted == 0; }

Uninterrupted::Uninterrupted() { ++uninterrupted; }
Uninterrupted::~Uninterrupted() { --uninterrupted; }

}  // namespace edsc
