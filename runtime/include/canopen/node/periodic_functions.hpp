/// The periodic functions of an application class: `every(Milliseconds<10>)`, with or without the node after the
/// period. A search finds the periods of its overloads, which C++ cannot list.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "canopen/node/functions.hpp"
#include "canopen/node/period.hpp"

namespace canopen::handler_detail {

/// The periods of the functions of one handler.
template <class... P>
struct PeriodList {
  static constexpr std::size_t size = sizeof...(P);
};

template <class... First, class... Second>
[[nodiscard]] consteval PeriodList<First..., Second...> joined(PeriodList<First...>, PeriodList<Second...>) {
  return {};
}

/// Converts to each period from `Least` to `Most` us.
template <std::uint64_t Least, std::uint64_t Most>
struct PeriodIn {
  template <Period P>
  requires(period_detail::length_of<P> >= Least && period_detail::length_of<P> <= Most) operator P()
      const;  // NOLINT(google-explicit-constructor): stands for a period
};

/// Converts to references to each type that is not a period.
struct NoPeriod {
  template <class T>
  requires(!Period<std::remove_cv_t<T>>) operator T&() const;  // NOLINT(google-explicit-constructor): a value
};

/// Fits each parameter except `T&&`.
using AnyReference = function::AnyNode;

/// Whether no function of an application fits; more than one may.
template <class Function, class A, class... Values>
inline constexpr bool none_fits = requires(typename Function::template OrNone<A>& application, Values... values) {
  { Function::call(application, values...) } -> std::same_as<function::NoneFits>;
};

/// Whether a function `Function` has a first parameter that `First` converts to, alone or before another one.
template <class Function, class A, class First>
inline constexpr bool takes_first = !none_fits<Function, A, First> || !none_fits<Function, A, First, AnyReference>;

using AnyPeriod = PeriodIn<1, period_detail::longest>;

/// Divides the range of periods until each part has one period. At least one function has a period of the range.
template <class A, std::uint64_t Least, std::uint64_t Most>
[[nodiscard]] consteval auto find_periods() {
  constexpr std::uint64_t middle = Least + (Most - Least) / 2;
  if constexpr (Least == Most) {
    return PeriodList<Microseconds<Least>>{};
  } else if constexpr (!takes_first<function::Every, A, PeriodIn<Least, middle>>) {
    return find_periods<A, middle + 1, Most>();
  } else if constexpr (!takes_first<function::Every, A, PeriodIn<middle + 1, Most>>) {
    return find_periods<A, Least, middle>();
  } else {
    return joined(find_periods<A, Least, middle>(), find_periods<A, middle + 1, Most>());
  }
}

/// Empty as well if a function accepts something else in place of its period, as `auto` does.
template <class A>
[[nodiscard]] consteval auto periods_of_application() {
  if constexpr (function::Every::template is_declared<A>) {
    if constexpr (takes_first<function::Every, A, AnyPeriod> && !takes_first<function::Every, A, NoPeriod>)
      return find_periods<A, 1, period_detail::longest>();
    else
      return PeriodList<>{};
  } else {
    return PeriodList<>{};
  }
}

}  // namespace canopen::handler_detail
