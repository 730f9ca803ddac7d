/// The result of checks at compile time, as a type: the check that fails, whose static_assert has the message. It is
/// completed only where the result is required, so that the compiler lists few templates in its message.
#pragma once

#include <type_traits>

namespace canopen {

/// A check that passes.
struct Passed {
  static constexpr bool is_good = true;
};

/// `Check` is Passed, or a class with an `is_good` whose static_assert fails. `is_good` is its first member: Clang does
/// not instantiate those after the static_assert, and would report that, too.
template <class Check>
struct Verdict {
  using type = Check;
};

/// The verdict of one check.
template <bool Passes, class Check>
using VerdictOf = Verdict<std::conditional_t<Passes, Passed, Check>>;

namespace verdict_detail {

template <class... Checks>
struct FirstFailure {
  using type = Passed;
};
template <class First, class... Others>
struct FirstFailure<First, Others...> {
  using type = First;
};
template <class... Others>
struct FirstFailure<Passed, Others...> : FirstFailure<Others...> {};

}  // namespace verdict_detail

/// Returns the first verdict that is not Passed. Called as `canopen::first_failure`: a search for functions in the
/// namespaces of the checks would complete them.
template <class... Checks>
[[nodiscard]] constexpr auto first_failure(Verdict<Checks>... /*verdicts*/) {
  return Verdict<typename verdict_detail::FirstFailure<Checks...>::type>{};
}

}  // namespace canopen
