/// The Nucleo-G474RE: the crystal for all clocks, LPUART1 behind ST-LINK's serial line, TIM2, flash, and the pins of
/// FDCAN1. After the reference manual RM0440 and the board's manual UM2505; it has not run on a board yet. Not done: a
/// word of flash that was being written when the power went is an ECC error, and reading it an NMI.
#include "board.hpp"

#include <cstring>

#include "registers.hpp"

namespace board {
namespace {

constexpr std::uint32_t clock = 24'000'000;  // Hz: the crystal, without PLL and without wait states of flash

namespace rcc {
constexpr std::uintptr_t base = 0x4002'1000;
constexpr std::uintptr_t cr = base + 0x00;
constexpr std::uintptr_t cfgr = base + 0x08;
constexpr std::uintptr_t ahb2enr = base + 0x4C;
constexpr std::uintptr_t apb1enr1 = base + 0x58;
constexpr std::uintptr_t apb1enr2 = base + 0x5C;
constexpr std::uintptr_t ccipr = base + 0x88;
constexpr std::uint32_t crystal_on = 1 << 16;
constexpr std::uint32_t crystal_ready = 1 << 17;
constexpr std::uint32_t switch_mask = 3;
constexpr std::uint32_t switch_to_crystal = 2;
constexpr std::uint32_t switched_mask = 3 << 2;
constexpr std::uint32_t switched_to_crystal = 2 << 2;
constexpr std::uint32_t gpio_a = 1;               // AHB2ENR
constexpr std::uint32_t tim2 = 1;                 // APB1ENR1
constexpr std::uint32_t fdcan = 1 << 25;          // APB1ENR1
constexpr std::uint32_t lpuart1 = 1;              // APB1ENR2
constexpr std::uint32_t fdcan_source = 3 << 24;   // CCIPR: 0 is the crystal
constexpr std::uint32_t lpuart_source = 3 << 10;  // CCIPR: 0 is PCLK1
}  // namespace rcc

namespace gpio_a {
constexpr std::uintptr_t base = 0x4800'0000;
constexpr std::uintptr_t mode = base + 0x00;
constexpr std::uintptr_t function_low = base + 0x20;   // pins 0 to 7
constexpr std::uintptr_t function_high = base + 0x24;  // pins 8 to 15
constexpr std::uint32_t alternate = 2;
}  // namespace gpio_a

namespace lpuart1 {
constexpr std::uintptr_t base = 0x4000'8000;
constexpr std::uintptr_t control = base + 0x00;
constexpr std::uintptr_t divider = base + 0x0C;
constexpr std::uintptr_t state = base + 0x1C;
constexpr std::uintptr_t clear = base + 0x20;
constexpr std::uintptr_t received = base + 0x24;
constexpr std::uintptr_t sent = base + 0x28;
constexpr std::uint32_t enabled = 1 << 0 | 1 << 2 | 1 << 3;  // with receiver and sender
constexpr std::uint32_t overrun = 1 << 3;
constexpr std::uint32_t receive_full = 1 << 5;
constexpr std::uint32_t send_empty = 1 << 7;
}  // namespace lpuart1

namespace tim2 {
constexpr std::uintptr_t base = 0x4000'0000;
constexpr std::uintptr_t control = base + 0x00;
constexpr std::uintptr_t event = base + 0x14;
constexpr std::uintptr_t count = base + 0x24;
constexpr std::uintptr_t prescaler = base + 0x28;
}  // namespace tim2

namespace flash {
constexpr std::uintptr_t base = 0x4002'2000;
constexpr std::uintptr_t access = base + 0x00;
constexpr std::uintptr_t key = base + 0x08;
constexpr std::uintptr_t state = base + 0x10;
constexpr std::uintptr_t control = base + 0x14;
constexpr std::uint32_t data_cache = 1 << 10;   // access
constexpr std::uint32_t busy = 1 << 16;         // state
constexpr std::uint32_t errors = 0x0000'C3FA;   // state
constexpr std::uint32_t program = 1 << 0;       // control
constexpr std::uint32_t erase = 1 << 1;         // control
constexpr std::uint32_t second_bank = 1 << 11;  // control
constexpr std::uint32_t begin = 1 << 16;        // control
constexpr std::uint32_t locked = 1u << 31;      // control
}  // namespace flash

/// The last pages of the second bank: the program goes on in the first bank while one is erased.
constexpr std::uintptr_t pages = 0x0807'E000;
constexpr std::uint32_t first_page = 124;  // of the bank

std::uint32_t number_of(unsigned pair, unsigned page) { return 2 * pair + page; }
std::uintptr_t page_at(unsigned pair, unsigned page) { return pages + number_of(pair, page) * Flash::page_size; }

void set_bits(std::uintptr_t address, std::uint32_t bits) { word_at(address) = word_at(address) | bits; }
void clear_bits(std::uintptr_t address, std::uint32_t bits) { word_at(address) = word_at(address) & ~bits; }

/// A pin of port A to a peripheral.
void give_pin(unsigned pin, std::uint32_t function) {
  const std::uintptr_t functions = pin < 8 ? gpio_a::function_low : gpio_a::function_high;
  clear_bits(functions, 0xFu << pin % 8 * 4);
  set_bits(functions, function << pin % 8 * 4);
  clear_bits(gpio_a::mode, 3u << pin * 2);
  set_bits(gpio_a::mode, gpio_a::alternate << pin * 2);
}

/// Until flash has done what `operation` asks for. False: it could not.
template <class Operation>
bool change_flash(std::uint32_t operation, Operation&& run) {
  if ((word_at(flash::control) & flash::locked) != 0) {
    word_at(flash::key) = 0x4567'0123;
    word_at(flash::key) = 0xCDEF'89AB;
  }
  word_at(flash::state) = flash::errors;
  word_at(flash::control) = operation;
  run();
  while ((word_at(flash::state) & flash::busy) != 0) {
  }
  const bool done = (word_at(flash::state) & flash::errors) == 0;
  word_at(flash::control) = flash::locked;
  return done;
}

}  // namespace

void start() {
  set_bits(rcc::cr, rcc::crystal_on);
  while ((word_at(rcc::cr) & rcc::crystal_ready) == 0) {
  }
  word_at(rcc::cfgr) = (word_at(rcc::cfgr) & ~rcc::switch_mask) | rcc::switch_to_crystal;
  while ((word_at(rcc::cfgr) & rcc::switched_mask) != rcc::switched_to_crystal) {
  }
  clear_bits(rcc::ccipr, rcc::fdcan_source | rcc::lpuart_source);
  set_bits(rcc::ahb2enr, rcc::gpio_a);
  set_bits(rcc::apb1enr1, rcc::tim2 | rcc::fdcan);
  set_bits(rcc::apb1enr2, rcc::lpuart1);
  clear_bits(flash::access, flash::data_cache);  // it would not see what is written to flash

  word_at(tim2::prescaler) = clock / 1'000'000 - 1;
  word_at(tim2::event) = 1;  // which takes the prescaler over
  word_at(tim2::control) = 1;

  give_pin(2, 12);  // LPUART1_TX
  give_pin(3, 12);  // LPUART1_RX
  word_at(lpuart1::divider) = static_cast<std::uint32_t>(std::uint64_t{clock} * 256 / 115'200);
  word_at(lpuart1::control) = lpuart1::enabled;

  give_pin(11, 9);  // FDCAN1_RX
  give_pin(12, 9);  // FDCAN1_TX
}

canopen::TimePoint now() { return canopen::TimePoint{canopen::Duration{word_at(tim2::count)}}; }

bool uart_put(char character) {
  if ((word_at(lpuart1::state) & lpuart1::send_empty) == 0) return false;
  word_at(lpuart1::sent) = static_cast<std::uint8_t>(character);
  return true;
}

std::optional<char> uart_get() {
  if ((word_at(lpuart1::state) & lpuart1::overrun) != 0) word_at(lpuart1::clear) = lpuart1::overrun;
  if ((word_at(lpuart1::state) & lpuart1::receive_full) == 0) return std::nullopt;
  return static_cast<char>(word_at(lpuart1::received));
}

bool Flash::erase(std::uint8_t page) {
  const std::uint32_t operation = flash::erase | flash::second_bank | (first_page + number_of(pair_, page)) << 3;
  return change_flash(operation, [&] { word_at(flash::control) = operation | flash::begin; });
}

/// A word is 64 bits for this flash: two writes of 32.
bool Flash::write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
  for (std::uint32_t done = 0; done < words.size(); done += word_size) {
    std::uint32_t halves[2];
    std::memcpy(halves, words.data() + done, sizeof halves);
    const std::uintptr_t place = page_at(pair_, page) + offset + done;
    const bool written = change_flash(flash::program, [&] {
      word_at(place) = halves[0];
      asm volatile("isb" ::: "memory");
      word_at(place + 4) = halves[1];
    });
    if (!written) return false;
  }
  return true;
}

bool Flash::read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) {
  std::memcpy(to.data(), reinterpret_cast<const void*>(page_at(pair_, page) + offset), to.size());
  return true;
}

}  // namespace board
