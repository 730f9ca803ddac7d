/// The MPS2 boards of Arm, with the peripherals of AN385 and AN386: CMSDK UART 0 and the counter of the FPGA's
/// registers.
#include "board.hpp"

#include <cstring>

#include "registers.hpp"

namespace board {
namespace {

constexpr std::uint32_t clock = 25'000'000;  // Hz

namespace uart {
constexpr std::uintptr_t base = 0x4000'4000;
constexpr std::uintptr_t data = base + 0x00;
constexpr std::uintptr_t state = base + 0x04;
constexpr std::uintptr_t control = base + 0x08;
constexpr std::uintptr_t divider = base + 0x10;
constexpr std::uint32_t send_full = 1;     // state
constexpr std::uint32_t receive_full = 2;  // state
constexpr std::uint32_t enabled = 3;       // control: sender and receiver
}  // namespace uart

constexpr std::uintptr_t counter = 0x4002'8018;
constexpr std::uintptr_t counter_prescale = 0x4002'801C;

/// The board has no flash: its PSRAM stands for it, which a reset leaves alone and a loss of power does not.
constexpr std::uintptr_t pages = 0x2100'0000;

std::uint8_t* page_at(unsigned pair, unsigned page) {
  return reinterpret_cast<std::uint8_t*>(pages + (2 * pair + page) * Flash::page_size);
}

}  // namespace

void start() {
  word_at(counter_prescale) = clock / 1'000'000 - 1;
  word_at(uart::divider) = clock / 115'200;
  word_at(uart::control) = uart::enabled;
}

canopen::TimePoint now() { return canopen::TimePoint{canopen::Duration{word_at(counter)}}; }

bool uart_put(char character) {
  if ((word_at(uart::state) & uart::send_full) != 0) return false;
  word_at(uart::data) = static_cast<std::uint8_t>(character);
  return true;
}

std::optional<char> uart_get() {
  if ((word_at(uart::state) & uart::receive_full) == 0) return std::nullopt;
  return static_cast<char>(word_at(uart::data));
}

bool Flash::erase(std::uint8_t page) {
  std::memset(page_at(pair_, page), 0xFF, page_size);
  return true;
}

/// As flash does it: bits become 0 only.
bool Flash::write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
  std::uint8_t* to = page_at(pair_, page) + offset;
  for (const std::uint8_t byte : words) *to++ &= byte;
  return true;
}

bool Flash::read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) {
  std::memcpy(to.data(), page_at(pair_, page) + offset, to.size());
  return true;
}

}  // namespace board
