/// Copies and clears any number of bytes. In code that is compiled for size, by a loop of its own: the library's memcpy and
/// memset would take hundreds of bytes of an image.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace canopen {

#ifdef __OPTIMIZE_SIZE__

/// The fence keeps a compiler from taking the loop for a memcpy.
[[gnu::noinline]] inline void copy_bytes(void* to, const void* from, std::size_t size) {
  auto* at = static_cast<std::uint8_t*>(to);
  const auto* source = static_cast<const std::uint8_t*>(from);
  for (std::uint8_t* const end = at + size; at != end;) {
    *at++ = *source++;
    std::atomic_signal_fence(std::memory_order_acq_rel);
  }
}

[[gnu::noinline]] inline void clear_bytes(void* to, std::size_t size) {
  auto* at = static_cast<std::uint8_t*>(to);
  for (std::uint8_t* const end = at + size; at != end;) {
    *at++ = 0;
    std::atomic_signal_fence(std::memory_order_acq_rel);
  }
}

#else

inline void copy_bytes(void* to, const void* from, std::size_t size) {
  if (size != 0) std::memcpy(to, from, size);
}

inline void clear_bytes(void* to, std::size_t size) { std::memset(to, 0, size); }

#endif

}  // namespace canopen
