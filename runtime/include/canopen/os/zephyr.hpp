/// A node in a thread of Zephyr. Empty if zephyr/kernel.h is not among the include directories.
///
///     canopen::Zephyr system;
///
///     void canopen_thread(void*, void*, void*) { canopen::NodeTask{pump, bus, system}.run(); }
///
/// and in the interrupt of the CAN controller, or the callback of can_add_rx_filter, which has put the frame into a
/// canopen::ReceiveQueue:
///
///     system.wake();
#pragma once

#if __has_include(<zephyr/kernel.h>)

#include <cstdint>

#include <zephyr/kernel.h>

#include "canopen/base/clock.hpp"
#include "canopen/os/node_task.hpp"

namespace canopen {

/// Waits for a semaphore. `wake` may be called from interrupts and threads. Deadlines are met within two ticks
/// (CONFIG_SYS_CLOCK_TICKS_PER_SEC).
class Zephyr {
 public:
  Zephyr() { static_cast<void>(k_sem_init(&work_, 0, 1)); }
  Zephyr(const Zephyr&) = delete;
  Zephyr& operator=(const Zephyr&) = delete;

  [[nodiscard]] TimePoint now() const {
    return TimePoint{
        Duration{static_cast<std::uint32_t>(k_ticks_to_us_floor64(static_cast<std::uint64_t>(k_uptime_ticks())))}};
  }
  /// One tick.
  [[nodiscard]] static Duration shortest_wait() {
    return Duration{static_cast<std::uint32_t>(k_ticks_to_us_ceil64(1))};
  }

  void wait(Duration span) { static_cast<void>(k_sem_take(&work_, K_USEC(span.count()))); }
  void wake() { k_sem_give(&work_); }

 private:
  k_sem work_;
};

}  // namespace canopen

#endif
