#include "device/generators.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace edsc {
namespace {

double constant_value(const GeneratorSettings& settings, std::uint64_t /*elapsed_us*/, std::uint64_t /*step*/) {
  return settings.numbers[0];
}

double ramp_value(const GeneratorSettings& settings, std::uint64_t elapsed_us, std::uint64_t /*step*/) {
  const auto [from, to] = settings.numbers;
  if (elapsed_us >= settings.time_us) return to;
  return from + (to - from) * static_cast<double>(elapsed_us) / static_cast<double>(settings.time_us);
}

/// Begins in the middle.
double sine_value(const GeneratorSettings& settings, std::uint64_t elapsed_us, std::uint64_t /*step*/) {
  const auto [low, high] = settings.numbers;
  const double part = static_cast<double>(elapsed_us % settings.time_us) / static_cast<double>(settings.time_us);
  return (low + high) / 2 + (high - low) / 2 * std::sin(2 * std::numbers::pi * part);
}

/// SplitMix64: the numbers of a seed are the same on each computer.
double noise_value(const GeneratorSettings& settings, std::uint64_t /*elapsed_us*/, std::uint64_t step) {
  std::uint64_t mixed = settings.seed + (step + 1) * 0x9E37'79B9'7F4A'7C15U;
  mixed = (mixed ^ mixed >> 30) * 0xBF58'476D'1CE4'E5B9U;
  mixed = (mixed ^ mixed >> 27) * 0x94D0'49BB'1331'11EBU;
  mixed ^= mixed >> 31;
  const auto [low, high] = settings.numbers;
  constexpr unsigned unused_bits = 11;
  return low + (high - low) * std::ldexp(static_cast<double>(mixed >> unused_bits), -53);
}

double count_value(const GeneratorSettings& settings, std::uint64_t /*elapsed_us*/, std::uint64_t step) {
  return settings.numbers[0] + settings.numbers[1] * static_cast<double>(step);
}

// clang-format off
constexpr GeneratorKind generator_table[] = {
    {"constant", "OBJ VALUE [every TIME]",       "the value, also after a reset or when a master has written another", false, false, OutOfRange::nearest, constant_value},
    {"ramp",     "OBJ FROM TO TIME [every TIME]", "from one value to the other in this time",                           false, true,  OutOfRange::nearest, ramp_value},
    {"sine",     "OBJ LOW HIGH TIME [every TIME]", "between two values, with this period",                              false, false, OutOfRange::nearest, sine_value},
    {"noise",    "OBJ LOW HIGH TIME",            "a random value between two values, a new one after each TIME",        true,  false, OutOfRange::nearest, noise_value},
    {"count",    "OBJ FROM STEP TIME",           "more by STEP after each TIME, from the lowest value again after the highest", true, false, OutOfRange::wraps, count_value},
};
// clang-format on

}  // namespace

std::span<const GeneratorKind> generator_kinds() { return generator_table; }

const GeneratorKind* find_generator(std::string_view name) {
  const auto* const row = std::ranges::find(generator_table, name, &GeneratorKind::name);
  return row == std::end(generator_table) ? nullptr : row;
}

}  // namespace edsc
