/// Lock policies of canopen::Locked.
#pragma once

#include <concepts>
#include <cstdint>

namespace canopen {

/// A lock that one context holds at a time, such as std::mutex.
template <class Type>
concept Lock = requires(Type& lock) {
  lock.lock();
  lock.unlock();
};

/// For a node that is used in one context: takes no flash, RAM or time.
struct NoLock {
  constexpr void lock() {}
  constexpr void unlock() {}
};

/// The interrupts of a core: `disable` returns their state before, `restore` sets it again. `CortexMInterrupts` in
/// port/cortex_m.hpp is one.
template <class Type>
concept InterruptControl = requires(std::uint32_t state) {
  { Type::disable() } -> std::same_as<std::uint32_t>;
  Type::restore(state);
};

/// No interrupt occurs while it is held. May be taken again by the context that holds it. For a core with one
/// processor.
template <InterruptControl Interrupts>
class InterruptLock {
 public:
  void lock() {
    const std::uint32_t before = Interrupts::disable();
    if (depth_++ == 0) before_ = before;
  }
  void unlock() {
    if (--depth_ == 0) Interrupts::restore(before_);
  }

 private:
  std::uint32_t before_ = 0;  ///< state before the outermost lock
  std::uint8_t depth_ = 0;
};

}  // namespace canopen
