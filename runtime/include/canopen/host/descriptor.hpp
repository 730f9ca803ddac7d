/// A file descriptor with an owner. POSIX, host side.
#pragma once

#include <unistd.h>

#include <utility>

namespace canopen {

/// Closes its file descriptor when destroyed.
class Descriptor {
 public:
  Descriptor() = default;
  /// `number` is the result of the call that opened it; nothing is open if it is negative.
  explicit Descriptor(int number) : number_{number} {}
  Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { static_cast<void>(close()); }

  [[nodiscard]] explicit operator bool() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }

  /// Returns the result of close(2): some file systems report a full disk only now. 0 if nothing is open.
  [[nodiscard]] int close() { return number_ < 0 ? 0 : ::close(std::exchange(number_, -1)); }

 private:
  int number_ = -1;
};

}  // namespace canopen
