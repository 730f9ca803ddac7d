/// The bit rates of CiA 301, 5.3: those of table 0 of CiA 305, without its reserved index.
#pragma once

#include <algorithm>
#include <array>
#include <canopen/lss/lss_options.hpp>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace edsc {

namespace bit_rate_table {
inline constexpr auto is_used = [](std::uint16_t rate) { return rate != 0; };
inline constexpr std::size_t count = std::ranges::count_if(canopen::lss::bit_rates, is_used);
}  // namespace bit_rate_table

/// kbit/s, ascending
inline constexpr auto bit_rates = [] {
  std::array<std::uint16_t, bit_rate_table::count> rates{};
  std::ranges::copy_if(canopen::lss::bit_rates, rates.begin(), bit_rate_table::is_used);
  std::ranges::sort(rates);
  return rates;
}();

[[nodiscard]] constexpr bool is_bit_rate(std::uint64_t kbit_per_second) {
  return std::ranges::find(bit_rates, kbit_per_second) != bit_rates.end();
}

}  // namespace edsc
