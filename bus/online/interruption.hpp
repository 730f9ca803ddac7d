/// Ctrl-C and SIGTERM while a command talks to a bus.
#pragma once

#include <csignal>

namespace edsc {

/// Thrown when a command has left the bus clean because it was told to end.
struct Interrupted {};

/// As long as it lives, SIGINT and SIGTERM are noted, so that a command can abort its transfer. The second one ends the
/// program at once. One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] static bool noted();

 private:
  struct sigaction before_int_ {};
  struct sigaction before_term_ {};
};

/// As long as it lives, an interruption is not noted: for what a command does to leave a device as it was. The second
/// signal ends the program all the same.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace edsc
