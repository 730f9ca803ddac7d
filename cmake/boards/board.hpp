/// What a program asks of its board. Each board folder has a source that does it.
#pragma once

#include <canopen/base/clock.hpp>
#include <cstdint>
#include <optional>
#include <span>

namespace board {

/// Clocks, the timer and the serial line: 115,200 bit/s, 8 bits, no parity. To be called first.
void start();

/// Time since `start`, in us.
[[nodiscard]] canopen::TimePoint now();

/// A character to the serial line. False: there is no room now.
[[nodiscard]] bool uart_put(char character);

/// The next character from the serial line, if there is one.
[[nodiscard]] std::optional<char> uart_get();

#ifndef EDSC_BOARD_FLASH_PAGE
#define EDSC_BOARD_FLASH_PAGE 2048
#endif
#ifndef EDSC_BOARD_FLASH_WORD
#define EDSC_BOARD_FLASH_WORD 4
#endif

/// Two pages for a canopen::FlashStorage. There are two such pairs, with the numbers 0 and 1. `board_flash_page` and
/// `board_flash_word` of board.cmake say how large a page is that can be erased by itself, and a word that can be
/// written by itself.
class Flash {
 public:
  static constexpr std::uint32_t page_size = EDSC_BOARD_FLASH_PAGE;
  static constexpr std::uint32_t word_size = EDSC_BOARD_FLASH_WORD;

  explicit constexpr Flash(std::uint8_t pair) : pair_{pair} {}

  bool erase(std::uint8_t page);
  bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words);
  bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to);

 private:
  std::uint8_t pair_;
};

}  // namespace board
