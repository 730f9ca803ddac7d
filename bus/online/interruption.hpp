/// Ctrl-C and SIGTERM while a command talks to a bus.
#pragma once

namespace edsc {

/// Thrown after an interruption, when a command has ended its transfers.
struct Interrupted {};

/// During its lifetime, SIGINT and SIGTERM are recorded, so that a command can abort its transfer. The second one ends
/// the program immediately. Only one object may exist at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  [[nodiscard]] static bool noted();
};

/// During its lifetime, an interruption is ignored, so that a command can restore the device. The second signal still
/// ends the program.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace edsc
