#include "online/interruption.hpp"

#include <csignal>

namespace edsc {
namespace {

volatile std::sig_atomic_t noted_signal = 0;
int uninterrupted = 0;  ///< number of Uninterrupted objects
struct sigaction before_int, before_term;

}  // namespace

Interruption::Interruption() {
  noted_signal = 0;
  struct sigaction note {};
  note.sa_handler = [](int signal) { noted_signal = signal; };
  sigemptyset(&note.sa_mask);
  note.sa_flags = static_cast<int>(SA_RESETHAND);  // not SA_RESTART: a wait for the bus ends
  sigaction(SIGINT, &note, &before_int);
  sigaction(SIGTERM, &note, &before_term);
}

Interruption::~Interruption() {
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
}

bool Interruption::noted() { return noted_signal != 0 && uninterrupted == 0; }

Uninterrupted::Uninterrupted() { ++uninterrupted; }
Uninterrupted::~Uninterrupted() { --uninterrupted; }

}  // namespace edsc
