#include "text/duration.hpp"

#include <algorithm>
#include <iterator>

namespace edsc {
namespace {

struct DurationUnit {
  std::string_view name;
  std::uint64_t microseconds;
};

/// Largest first.
constexpr DurationUnit duration_units[] = {
    {"h", 3'600'000'000}, {"m", 60'000'000}, {"s", 1'000'000}, {"ms", 1000}, {"us", 1}};

}  // namespace

std::optional<std::uint64_t> parse_duration(std::string_view text) {
  const std::size_t unit_at = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::string_view digits = text.substr(0, unit_at);
  const auto* const unit = std::ranges::find(duration_units, text.substr(unit_at), &DurationUnit::name);
  if (unit == std::end(duration_units) || digits.empty() || digits.front() == '.' || digits.back() == '.') {
    return std::nullopt;
  }
  std::uint64_t sum = 0;
  std::uint64_t weight = unit->microseconds;  // of the last digit
  bool is_fraction = false;
  for (const char c : digits) {
    if (c == '.') {
      if (is_fraction) return std::nullopt;
      is_fraction = true;
      continue;
    }
    const auto digit = static_cast<std::uint64_t>(c - '0');
    if (is_fraction) {
      if (weight % 10 != 0 && digit != 0) return std::nullopt;
      weight /= 10;
      sum += digit * weight;
    } else {
      sum = sum * 10 + digit * weight;
    }
    if (sum > max_duration_us) return std::nullopt;
  }
  return sum;
}

std::string duration_text(std::uint64_t microseconds) {
  if (microseconds == 0) return "0s";
  const auto* const unit = std::ranges::find_if(
      duration_units, [&](const DurationUnit& row) { return microseconds % row.microseconds == 0; });
  return std::to_string(microseconds / unit->microseconds).append(unit->name);
}

}  // namespace edsc
