/// The BBC micro:bit: UART, TIMER0 and NVMC of its nRF51822.
#include "board.hpp"

#include <cstring>

#include "registers.hpp"

namespace board {
namespace {

namespace clock {
constexpr std::uintptr_t start_crystal = 0x4000'0000;
constexpr std::uintptr_t crystal_started = 0x4000'0100;
}  // namespace clock

namespace uart {
constexpr std::uintptr_t base = 0x4000'2000;
constexpr std::uintptr_t start_receiving = base + 0x000;
constexpr std::uintptr_t start_sending = base + 0x008;
constexpr std::uintptr_t received = base + 0x108;
constexpr std::uintptr_t sent = base + 0x11C;
constexpr std::uintptr_t enable = base + 0x500;
constexpr std::uintptr_t send_pin = base + 0x50C;
constexpr std::uintptr_t receive_pin = base + 0x514;
constexpr std::uintptr_t receive_data = base + 0x518;
constexpr std::uintptr_t send_data = base + 0x51C;
constexpr std::uintptr_t bit_rate = base + 0x524;
}  // namespace uart

namespace timer {
constexpr std::uintptr_t base = 0x4000'8000;
constexpr std::uintptr_t start = base + 0x000;
constexpr std::uintptr_t capture = base + 0x040;
constexpr std::uintptr_t width = base + 0x508;
constexpr std::uintptr_t prescaler = base + 0x510;
constexpr std::uintptr_t captured = base + 0x540;
}  // namespace timer

namespace nvmc {
constexpr std::uintptr_t base = 0x4001'E000;
constexpr std::uintptr_t ready = base + 0x400;
constexpr std::uintptr_t mode = base + 0x504;
constexpr std::uintptr_t erase_page = base + 0x508;
constexpr std::uint32_t reading = 0;
constexpr std::uint32_t writing = 1;
constexpr std::uint32_t erasing = 2;
constexpr std::uint32_t page_size = 1024;
}  // namespace nvmc

constexpr std::uintptr_t pages = 0x0003'E000;

std::uintptr_t page_at(unsigned pair, unsigned page) { return pages + (2 * pair + page) * Flash::page_size; }

void enter(std::uint32_t mode) {
  while (word_at(nvmc::ready) == 0) {
  }
  word_at(nvmc::mode) = mode;
}

bool uart_busy = false;

}  // namespace

void start() {
  word_at(clock::start_crystal) = 1;  // the UART and the timer need its accuracy
  while (word_at(clock::crystal_started) == 0) {
  }
  word_at(timer::width) = 3;      // 32 bits
  word_at(timer::prescaler) = 4;  // 16 MHz / 2^4
  word_at(timer::start) = 1;
  word_at(uart::send_pin) = 24;
  word_at(uart::receive_pin) = 25;
  word_at(uart::bit_rate) = 0x01D7'E000;  // 115,200 bit/s
  word_at(uart::enable) = 4;
  word_at(uart::start_sending) = 1;
  word_at(uart::start_receiving) = 1;
}

canopen::TimePoint now() {
  word_at(timer::capture) = 1;
  return canopen::TimePoint{canopen::Duration{word_at(timer::captured)}};
}

bool uart_put(char character) {
  if (uart_busy && word_at(uart::sent) == 0) return false;
  word_at(uart::sent) = 0;
  word_at(uart::send_data) = static_cast<std::uint8_t>(character);
  uart_busy = true;
  return true;
}

std::optional<char> uart_get() {
  if (word_at(uart::received) == 0) return std::nullopt;
  word_at(uart::received) = 0;
  return static_cast<char>(word_at(uart::receive_data));
}

bool Flash::erase(std::uint8_t page) {
  enter(nvmc::erasing);
  for (std::uint32_t done = 0; done < page_size; done += nvmc::page_size) {
    word_at(nvmc::erase_page) = page_at(pair_, page) + done;
    while (word_at(nvmc::ready) == 0) {
    }
  }
  enter(nvmc::reading);
  return true;
}

bool Flash::write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
  enter(nvmc::writing);
  for (std::uint32_t done = 0; done < words.size(); done += word_size) {
    std::uint32_t word;
    std::memcpy(&word, words.data() + done, sizeof word);
    word_at(page_at(pair_, page) + offset + done) = word;
    while (word_at(nvmc::ready) == 0) {
    }
  }
  enter(nvmc::reading);
  return true;
}

bool Flash::read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) {
  std::memcpy(to.data(), reinterpret_cast<const void*>(page_at(pair_, page) + offset), to.size());
  return true;
}

}  // namespace board
