/// The part of Zephyr that canopen/os/zephyr.hpp uses, with the semantics of its manual, on threads of C++. 10,000
/// ticks per second.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>

struct k_sem {
  std::mutex mutex;
  std::condition_variable changed;
  unsigned count = 0;
  unsigned limit = 1;
};
struct k_timeout_t {
  std::chrono::microseconds span;
};
#define K_USEC(count)                   \
  k_timeout_t {                         \
    std::chrono::microseconds { count } \
  }

inline int k_sem_init(k_sem* semaphore, unsigned count, unsigned limit) {
  semaphore->count = count;
  semaphore->limit = limit;
  return 0;
}

inline void k_sem_give(k_sem* semaphore) {
  const std::lock_guard lock{semaphore->mutex};
  if (semaphore->count < semaphore->limit) ++semaphore->count;
  semaphore->changed.notify_one();
}

inline int k_sem_take(k_sem* semaphore, k_timeout_t timeout) {
  std::unique_lock lock{semaphore->mutex};
  if (!semaphore->changed.wait_for(lock, timeout.span, [&] { return semaphore->count != 0; })) return -11;
  --semaphore->count;
  return 0;
}

inline std::int64_t k_uptime_ticks() {
  static const auto start = std::chrono::steady_clock::now();
  const auto passed = std::chrono::steady_clock::now() - start;
  return std::chrono::duration_cast<std::chrono::microseconds>(passed).count() / 100;
}
inline std::uint64_t k_ticks_to_us_floor64(std::uint64_t ticks) { return ticks * 100; }
inline std::uint64_t k_ticks_to_us_ceil64(std::uint64_t ticks) { return ticks * 100; }
