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
template <class... PeriodType>
struct PeriodList {
  static constexpr std::size_t size = sizeof...(PeriodType);
};

template <class... First, class... Second>
[[nodiscard]] consteval PeriodList<First..., Second...> joined(PeriodList<First...>, PeriodList<Second...>) {
  return {};
}

/// Converts to each period from `Least` to `Most` us.
template <std::uint64_t Least, std::uint64_t Most>
struct PeriodIn {
  template <Period PeriodType>
  requires(period_detail::length_of<PeriodType> >= Least && period_detail::length_of<PeriodType> <= Most)
  operator PeriodType() const;  // NOLINT(google-explicit-constructor): stands for a period
};

/// Converts to references to each type that is not a period.
struct NoPeriod {
  template <class Type>
  requires(!Period<std::remove_cv_t<Type>>) operator Type&() const;  // NOLINT(google-explicit-constructor): a value
};

/// Fits each parameter except `Type&&`.
using AnyReference = function::AnyNode;

/// Whether no function of an application fits; more than one may.
template <class Function, class Application, class... Values>
inline constexpr bool none_fits = requires(typename Function::template OrNone<Application>& application,
                                           Values... values) {
  { Function::call(application, values...) } -> std::same_as<function::NoneFits>;
};

/// Whether a function `Function` has a first parameter that `First` converts to, alone or before another one.
template <class Function, class Application, class First>
inline constexpr bool takes_first =
    !none_fits<Function, Application, First> || !none_fits<Function, Application, First, AnyReference>;

using AnyPeriod = PeriodIn<1, period_detail::longest>;

/// Divides the range of periods until each part has one period. At least one function has a period of the range.
template <class Application, std::uint64_t Least, std::uint64_t Most>
[[nodiscard]] consteval auto find_periods() {
  constexpr std::uint64_t middle = Least + (Most - Least) / 2;
  if constexpr (Least == Most) {
    return PeriodList<Microseconds<Least>>{};
  } else if constexpr (!takes_first<function::Every, Application, PeriodIn<Least, middle>>) {
    return find_periods<Application, middle + 1, Most>();
  } else if constexpr (!takes_first<function::Every, Application, PeriodIn<middle + 1, Most>>) {
    return find_periods<Application, Least, middle>();
  } else {
    return joined(find_periods<Application, Least, middle>(), find_periods<Application, middle + 1, Most>());
  }
}

/// Empty as well if a function accepts something else in place of its period, as `auto` does.
template <class Application>
[[nodiscard]] consteval auto periods_of_application() {
  if constexpr (function::Every::template is_declared<Application>) {
    if constexpr (takes_first<function::Every, Application, AnyPeriod> &&
                  !takes_first<function::Every, Application, NoPeriod>)
      return find_periods<Application, 1, period_detail::longest>();
    else
      return PeriodList<>{};
  } else {
    return PeriodList<>{};
  }
}

}  // namespace canopen::handler_detail
