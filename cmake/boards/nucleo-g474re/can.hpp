/// The CAN controller of the board.
#pragma once

#include <canopen/port/fdcan.hpp>
#include <cstdint>

namespace board {

using Can = canopen::FdcanG4;

inline constexpr std::uint32_t can_clock = 24'000'000;  ///< Hz: the crystal

/// FDCAN1, with its clock and pins on after `start`. There is one of it in a program.
[[nodiscard]] inline Can make_can() {
  return {*reinterpret_cast<canopen::FdcanG4Registers*>(0x4000'6400),
          reinterpret_cast<volatile std::uint32_t*>(0x4000'A400)};
}

}  // namespace board
