/// Values that change with time: one row for each kind of generator.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/entry_number.hpp"

namespace edsc {

/// The arguments of a generator. Numbers are raw numbers of its object, times microseconds.
struct GeneratorSettings {
  std::array<double, 2> numbers{};
  std::uint64_t time_us = 0;
  std::uint64_t seed = 0;
};

/// `value` returns the number at a time after the start, which is a multiple of the interval, `step` times.
struct GeneratorKind {
  std::string_view name;
  std::string_view arguments;
  std::string_view help;
  bool steps;  ///< a new value each TIME; otherwise at each interval
  bool ends;   ///< after TIME the value does not change any more
  OutOfRange out_of_range;
  double (*value)(const GeneratorSettings& settings, std::uint64_t elapsed_us, std::uint64_t step);
};

[[nodiscard]] std::span<const GeneratorKind> generator_kinds();
/// Null for an unknown name.
[[nodiscard]] const GeneratorKind* find_generator(std::string_view name);

/// How often a generator sets its object unless `every` states another interval.
inline constexpr std::uint64_t default_interval_us = 10'000;

}  // namespace edsc
