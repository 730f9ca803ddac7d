/// Start-up code of the programs in this folder on a Cortex-M: vectors, and memory initialization for C++. Each program
/// defines `program`.
#pragma once

#include <cstdint>

extern "C" {
extern std::uint32_t edsc_stack_top;
extern std::uint32_t __bss_start__;
extern std::uint32_t __bss_end__;
extern std::uint32_t __data_start__;
extern std::uint32_t __data_end__;
extern std::uint32_t __data_load__;
[[noreturn]] void reset();
[[gnu::section(".vectors"), gnu::used]] const void* const vectors[] = {&edsc_stack_top,
                                                                       reinterpret_cast<const void*>(reset)};
}

[[noreturn]] void program();

/// The compiler must not replace the loops by calls of the C library, which would then be in every image.
extern "C" [[gnu::optimize("no-tree-loop-distribute-patterns")]] void reset() {
  for (std::uint32_t *from = &__data_load__, *to = &__data_start__; to != &__data_end__;) *to++ = *from++;
  for (std::uint32_t* to = &__bss_start__; to != &__bss_end__;) *to++ = 0;
  program();
}
