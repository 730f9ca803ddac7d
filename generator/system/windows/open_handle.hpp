/// A handle of Windows with an owner.
#pragma once

#include <windows.h>

#include <utility>

namespace edsc {

/// Closes its handle when destroyed.
class OpenHandle {
 public:
  OpenHandle() = default;
  /// `handle` is the result of the call that opened it; nothing is open if that failed.
  explicit OpenHandle(HANDLE handle) : handle_{handle == INVALID_HANDLE_VALUE ? nullptr : handle} {}
  OpenHandle(OpenHandle&& other) noexcept : handle_{std::exchange(other.handle_, nullptr)} {}
  OpenHandle& operator=(OpenHandle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~OpenHandle() { close(); }

  void close() {
    if (handle_ != nullptr) CloseHandle(std::exchange(handle_, nullptr));
  }

  [[nodiscard]] explicit operator bool() const { return handle_ != nullptr; }
  [[nodiscard]] HANDLE get() const { return handle_; }

 private:
  HANDLE handle_ = nullptr;
};

}  // namespace edsc
