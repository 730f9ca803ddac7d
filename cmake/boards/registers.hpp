/// Registers by their address.
#pragma once

#include <cstdint>

namespace board {

[[nodiscard]] inline volatile std::uint32_t& word_at(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

}  // namespace board
