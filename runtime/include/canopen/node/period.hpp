/// Periods of the periodic functions of an application, known at compile time.
///
///     struct Pump {
///       void every(canopen::Milliseconds<10>, auto& node) { node.set(od::pressure{}, measured()); }
///       void every(canopen::Seconds<1>) { led.toggle(); }
///     };
#pragma once

#include <cstdint>

#include "canopen/base/clock.hpp"

namespace canopen {

namespace period_detail {

/// 30 minutes: deadlines are compared if they are at most 35 minutes apart.
inline constexpr std::uint64_t longest = 1'800'000'000;

/// Multiplies without an overflow: a result above the longest period stays above it.
[[nodiscard]] constexpr std::uint64_t scaled(std::uint64_t count, std::uint64_t unit) {
  return count <= longest ? count * unit : count;
}

}  // namespace period_detail

template <std::uint64_t microseconds>
concept PeriodFrom1UsTo30Minutes = microseconds >= 1 && microseconds <= period_detail::longest;

/// A period of 1 us to 30 minutes. All units are the same type: `Milliseconds<1000>` is `Seconds<1>`.
template <std::uint64_t count>
requires PeriodFrom1UsTo30Minutes<count>
struct Microseconds {
  static constexpr Duration duration{static_cast<std::uint32_t>(count)};
};
template <std::uint64_t count>
using Milliseconds = Microseconds<period_detail::scaled(count, 1'000)>;
template <std::uint64_t count>
using Seconds = Microseconds<period_detail::scaled(count, 1'000'000)>;

namespace period_detail {

/// The microseconds of a period; 0: another type.
template <class Type>
inline constexpr std::uint64_t length_of = 0;
template <std::uint64_t count>
inline constexpr std::uint64_t length_of<Microseconds<count>> = count;

}  // namespace period_detail

template <class Type>
concept Period = period_detail::length_of<Type>
!= 0;

}  // namespace canopen
