/// Interrupts of a Cortex-M. Empty for other cores.
#pragma once

#include <cstdint>

#include "canopen/base/lock.hpp"

#if defined(__arm__) && defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'

namespace canopen {

/// PRIMASK: all interrupts but NMI and HardFault.
struct CortexMInterrupts {
  [[nodiscard]] static std::uint32_t disable() {
    std::uint32_t before;
    __asm__ volatile("mrs %0, primask\n cpsid i" : "=r"(before) : : "memory");
    return before;
  }
  static void restore(std::uint32_t before) { __asm__ volatile("msr primask, %0" : : "r"(before) : "memory"); }
};

/// Sleeps until an interrupt, unless `awake()` is true; returns whether it has slept. The test and the sleep are one
/// step for interrupts: `wfi` also returns for an interrupt that is disabled here and served directly afterwards.
template <class Awake>
bool sleep_unless(Awake&& awake) {
  const std::uint32_t before = CortexMInterrupts::disable();
  const bool sleeps = !awake();
  if (sleeps) __asm__ volatile("dsb\n wfi" : : : "memory");
  CortexMInterrupts::restore(before);
  return sleeps;
}

using CortexMInterruptLock = InterruptLock<CortexMInterrupts>;

}  // namespace canopen

#endif
