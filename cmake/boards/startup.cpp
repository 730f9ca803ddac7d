/// What a Cortex-M begins with: vectors, and memory as C++ expects it.
#include <cstdint>

extern "C" {
extern std::uint32_t __stack_top__;
extern std::uint32_t __bss_start__;
extern std::uint32_t __bss_end__;
extern std::uint32_t __data_start__;
extern std::uint32_t __data_end__;
extern const std::uint32_t __data_load__;
using Constructor = void (*)();
extern const Constructor __init_array_start__;
extern const Constructor __init_array_end__;
[[noreturn]] void reset();
[[noreturn]] void halt();
/// A program may define it instead.
[[noreturn, gnu::nothrow, gnu::weak, gnu::alias("halt")]] void SysTick_Handler();
}

int main();

namespace {

/// Up to SysTick. Those of a chip's interrupts follow in the section .interrupt_vectors, if a program has any.
struct Vectors {
  const void* stack_top;
  void (*handlers[15])();
};
[[gnu::section(".vectors"), gnu::used]] constexpr Vectors vectors{
    &__stack_top__,
    {reset, halt, halt, halt, halt, halt, nullptr, nullptr, nullptr, nullptr, halt, halt, nullptr, halt,
     SysTick_Handler}};

}  // namespace

void halt() {
  for (;;) asm volatile("" ::: "memory");
}

/// The loops stay loops: no function of the C library is in an image for their sake.
[[gnu::optimize("no-tree-loop-distribute-patterns")]] void reset() {
  const std::uint32_t* from = &__data_load__;
  for (std::uint32_t* to = &__data_start__; to != &__data_end__;) *to++ = *from++;
  for (std::uint32_t* to = &__bss_start__; to != &__bss_end__;) *to++ = 0;
  for (const Constructor* run = &__init_array_start__; run != &__init_array_end__;) (*run++)();
  __extension__ main();  // which C++ would not have called
  halt();
}
