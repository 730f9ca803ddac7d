/// Counts instructions under QEMU (-M mps2-an386 -icount shift=0) and prints them over semihosting.
#pragma once

#include <cstdint>

namespace count_detail {

constexpr std::uint32_t instructions_per_tick = 40;  // SysTick runs at 25 MHz, an instruction takes 1 ns

inline volatile std::uint32_t& systick(std::uint32_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(0xE000'E010u + offset);
}

inline std::uint32_t semihosting(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
constexpr std::uint32_t write_text = 0x04;
constexpr std::uint32_t exit_program = 0x18;

}  // namespace count_detail

inline void start_counter() {
  count_detail::systick(4) = 0xFF'FFFF;
  count_detail::systick(8) = 0;
  count_detail::systick(0) = 5;
}

/// Counts the instructions of `run`, which must be less than 671 million.
template <class F>
std::uint32_t count(F run) {
  const std::uint32_t before = count_detail::systick(8);
  run();
  return ((before - count_detail::systick(8)) & 0xFF'FFFF) * count_detail::instructions_per_tick;
}

/// Prints `NAME INSTRUCTIONS`, divided by the number of units, with one decimal.
inline void print(const char* name, std::uint32_t instructions, std::uint32_t units) {
  char line[64];
  unsigned at = 0;
  while (*name != 0) line[at++] = *name++;
  line[at++] = ' ';
  char digits[12];
  unsigned digit = 0;
  for (auto tenths = static_cast<std::uint32_t>(std::uint64_t{instructions} * 10 / units); digit < 2 || tenths != 0;
       tenths /= 10) {
    digits[digit++] = static_cast<char>('0' + tenths % 10);
    if (digit == 1) digits[digit++] = '.';
  }
  if (digits[digit - 1] == '.') digits[digit++] = '0';
  while (digit != 0) line[at++] = digits[--digit];
  line[at++] = '\n';
  line[at] = 0;
  count_detail::semihosting(count_detail::write_text, line);
}

[[noreturn]] inline void end_program() {
  count_detail::semihosting(count_detail::exit_program, reinterpret_cast<const void*>(0x20026));
  for (;;) {
  }
}

/// Prints the mean of `run(i)` over a thousand calls.
template <class F>
void print_mean(const char* name, F run) {
  constexpr std::uint32_t calls = 1000;
  print(name, count([&] {
          for (std::uint32_t i = 0; i < calls; ++i) run(i);
        }),
        calls);
}
