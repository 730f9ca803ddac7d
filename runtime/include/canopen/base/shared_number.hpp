/// A number that one context writes and another one reads: an interrupt and the loop, or two threads.
#pragma once

#include <atomic>
#include <concepts>

namespace canopen {

/// One context calls `publish`, any other one `read`: what the writer did before `publish` is seen after `read`. Loads
/// and stores alone, so that a Cortex-M0 needs no library and no lock.
template <std::unsigned_integral Number>
class SharedNumber {
 public:
  [[nodiscard]] Number read() const { return number_.load(std::memory_order_acquire); }
  void publish(Number number) { number_.store(number, std::memory_order_release); }

  /// For the writer: its own last number, without a barrier.
  [[nodiscard]] Number own() const { return number_.load(std::memory_order_relaxed); }

 private:
  std::atomic<Number> number_{0};
};

}  // namespace canopen
