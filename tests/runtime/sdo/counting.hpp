/// Values of any length for tests of transfers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace bench {

/// The bytes 1, 2, 3 ...
template <std::size_t Size>
std::array<std::uint8_t, Size> counting() {
  std::array<std::uint8_t, Size> bytes;
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

}  // namespace bench
