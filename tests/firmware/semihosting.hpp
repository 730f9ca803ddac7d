/// Text from a program on QEMU to the host, with the option -semihosting.
#pragma once

#include <cstddef>
#include <cstdint>

namespace semihosting {

inline void call(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

inline void print(const char* text) { call(0x04, text); }

/// Prints a text and a number.
inline void print(const char* text, std::uint32_t number) {
  char digits[11];
  std::size_t at = sizeof digits;
  digits[--at] = 0;
  do {
    digits[--at] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  print(text);
  print(digits + at);
}

[[noreturn]] inline void exit() {
  call(0x18, reinterpret_cast<const void*>(0x20026));
  for (;;) {
  }
}

}  // namespace semihosting
