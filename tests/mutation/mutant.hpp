#pragma once

/// Included by each mutated source. The environment variable EDSC_MUTANT is the number of the active mutant; 0 or no
/// variable: none. EDSC_MUTANT_REACHED is the name of a file to which a process appends the numbers that it reaches.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace edsc_mutation {

inline constexpr std::size_t max_mutants = 65536;

inline unsigned active_mutant() {
  static const unsigned number = [] {
    const char* const text = std::getenv("EDSC_MUTANT");
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : 0U;
  }();
  return number;
}

/// Appends the number immediately: a process that is killed later has still reached the mutant.
inline void record_reached(unsigned number) {
  static const char* const path = std::getenv("EDSC_MUTANT_REACHED");
  static std::array<std::atomic<bool>, max_mutants> recorded{};
  if (path == nullptr || recorded[number].exchange(true)) return;
  if (std::FILE* const file = std::fopen(path, "a")) {
    std::fprintf(file, "%u\n", number);
    std::fclose(file);
  }
}

}  // namespace edsc_mutation

/// Returns whether a mutant of a table is active. Not constexpr, so that the table is initialized at run time.
inline bool edsc_table_mutant(unsigned number) {
  edsc_mutation::record_reached(number);
  return edsc_mutation::active_mutant() == number;
}

/// Returns whether a mutant is active; false in constant evaluation. A builtin, because CMake's compiler checks do not
/// use C++20.
constexpr bool edsc_mutant(unsigned number) {
  return __builtin_is_constant_evaluated() ? false : edsc_table_mutant(number);
}
