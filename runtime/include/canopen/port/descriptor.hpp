/// A file descriptor that has an owner. POSIX, host side.
#pragma once

#include <unistd.h>

#include <utility>

namespace canopen {

/// Closes its file descriptor at the end.
class Descriptor {
 public:
  Descriptor() = default;
  /// `number` is what the call that opened it returned: nothing is open where that is negative.
  explicit Descriptor(int number) : number_{number} {}
  Descriptor(Descriptor&& other) noexcept : number_{std::exchange(other.number_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() { static_cast<void>(close()); }

  [[nodiscard]] explicit operator bool() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }

  /// What close(2) returns: some file systems report a full disk only now. 0 where nothing is open.
  [[nodiscard]] int close() { return number_ < 0 ? 0 : ::close(std::exchange(number_, -1)); }

 private:
  int number_ = -1;
};

}  // namespace canopen
