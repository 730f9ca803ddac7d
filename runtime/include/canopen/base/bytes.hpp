/// Copies, clears and reads bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/optimization.hpp"

namespace canopen {

namespace bytes_detail {

/// Copies byte by byte: the library's memcpy and memset would add hundreds of bytes to an image. The fence keeps the
/// compiler from replacing these loops with calls of them; `<atomic>` would bring threads with it. The last byte is the
/// first, so that one register counts and addresses: saves 2 instructions of a Cortex-M0+ for each byte.
[[gnu::noinline]] inline void copy_by_loop(std::uint8_t* to, const std::uint8_t* from, std::size_t size) {
  while (size-- != 0) {
    to[size] = from[size];
    __atomic_signal_fence(__ATOMIC_ACQ_REL);
  }
}

[[gnu::noinline]] inline void clear_by_loop(std::uint8_t* to, std::size_t size) {
  while (size-- != 0) {
    to[size] = 0;
    __atomic_signal_fence(__ATOMIC_ACQ_REL);
  }
}

}  // namespace bytes_detail

/// Copies any number of bytes between memories that do not overlap. The loop saves the 152 bytes of memcpy on a
/// Cortex-M0+; a Cortex-M4 would take about 30 instructions more for seven bytes.
inline void copy_bytes(void* to, const void* from, std::size_t size) {
  if constexpr (prefers_size) {
    bytes_detail::copy_by_loop(static_cast<std::uint8_t*>(to), static_cast<const std::uint8_t*>(from), size);
  } else if (size != 0) {
    std::memcpy(to, from, size);
  }
}

/// Copies a small number of bytes, for which a call of memcpy would take longer. One loop for all saves 8 to 152 bytes
/// of a Cortex-M0+, and would take 4 instructions more of an SDO download on a Cortex-M4.
inline void copy_few_bytes(std::uint8_t* to, const std::uint8_t* from, std::size_t size) {
  if constexpr (prefers_size) {
    bytes_detail::copy_by_loop(to, from, size);
  } else {
    for (const std::uint8_t* const end = to + size; to != end;) *to++ = *from++;
  }
}

/// Clears any number of bytes. The loop saves the 156 bytes of memset on a Cortex-M0+.
inline void clear_bytes(void* to, std::size_t size) {
  if constexpr (prefers_size) {
    bytes_detail::clear_by_loop(static_cast<std::uint8_t*>(to), size);
  } else {
    std::memset(to, 0, size);
  }
}

/// Returns a little-endian number of up to four bytes.
[[nodiscard]] constexpr std::uint32_t little_endian_number(std::span<const std::uint8_t> bytes) {
  std::uint32_t number = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) number = (number << 8) | bytes[i - 1];
  return number;
}

}  // namespace canopen
