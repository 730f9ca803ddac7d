/// Checks the functions of an application class at the declaration of its node: one that the node would never call does
/// not compile. The compiler's message names the object or the function.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/clock.hpp"
#include "canopen/base/label.hpp"
#include "canopen/base/result.hpp"
#include "canopen/base/verdict.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/period.hpp"
#include "canopen/node/periodic_functions.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/object_list.hpp"

namespace canopen::handler_detail {

/// Converts to each type: fits each parameter.
struct AnyValue {
  template <class Type>
  operator Type() const;  // NOLINT(google-explicit-constructor): stands for a value
};

/// An object that no dictionary has: only a function for all objects accepts it.
struct NoObject {};

template <class Type, class Objects>
inline constexpr bool is_in = false;
template <class Type, class... Rows>
inline constexpr bool is_in<Type, ObjectRows<Rows...>> = std::disjunction_v<std::is_same<Type, Rows>...>;

template <class Type, class Row>
inline constexpr bool is_element = false;
template <template <std::uint8_t> class Array, std::uint8_t Position, std::uint8_t Highest>
inline constexpr bool is_element<Array<Position>, ArrayObjects<Array, Highest>> = Position <= Highest;
template <class Type, class Objects>
inline constexpr bool is_element_in = false;
template <class Type, class... Rows>
inline constexpr bool is_element_in<Type, ObjectRows<Rows...>> =
    std::disjunction_v<std::bool_constant<is_element<Type, Rows>>...>;

/// Converts to the generated type of each object that is not one of `Device`.
template <class Device>
struct ObjectOfAnother {
  template <DictionaryObject Type>
  requires(!is_in<Type, typename Device::Objects> && !is_element_in<Type, typename Device::Objects>) operator Type()
      const;  // NOLINT(google-explicit-constructor): stands for an object
};

/// A function for an object of another device; `Object` is known if the function has no overloads.
template <class Device, class Application, class Function, class Object>
struct FunctionOfAnotherDevice {
  static constexpr bool is_good = true;
  static_assert(!Function::template is_declared<Application>,
                "application: this device does not have the object of one of its functions");
};

/// The type of the first parameter of the function; void if it is overloaded or a template.
template <class Function, class ApplicationType>
struct FirstParameter {
  using type = void;
};
template <class Function, class ApplicationType>
requires requires { Function::template address<ApplicationType>; }
struct FirstParameter<Function, ApplicationType> {
  template <class Result, class First, class... Others>
  static std::type_identity<std::remove_cvref_t<First>> first(Result (ApplicationType::*)(First, Others...));
  template <class Result, class First, class... Others>
  static std::type_identity<std::remove_cvref_t<First>> first(Result (ApplicationType::*)(First, Others...) const);
  static std::type_identity<void> first(...);
  using type = typename decltype(first(Function::template address<ApplicationType>))::type;
};

template <class Type, class List>
inline constexpr bool is_listed = false;
template <class Type, class... Os>
inline constexpr bool is_listed<Type, ObjectList<Os...>> = (std::is_same_v<Type, Os> || ...);

/// A function with an object that the node does not call for it.
template <class Application, class Function, class Object>
struct UncalledFunction {
  static constexpr bool is_good = true;
  static_assert(!DictionaryObject<Object> || std::is_same_v<Function, function::Read>,
                "application: the node calls write and written with (object, value) or (object, value, node); a value "
                "is passed by value or as const&, and the node as auto&");
  static_assert(!DictionaryObject<Object> || !std::is_same_v<Function, function::Read>,
                "application: the node calls read with (object) or (object, node)");
};

/// Converts to each object of `Device` that is not one of `Called`.
template <class Device, class Called>
struct UncalledObject {
  template <DictionaryObject Type>
  requires((is_in<Type, typename Device::Objects> ||
            is_element_in<Type, typename Device::Objects>)&&!is_listed<Type, Called>)
  operator Type() const;  // NOLINT(google-explicit-constructor): stands for an object
};

/// The same for up to three further arguments of any type.
template <class Function, class ApplicationType, class Object>
inline constexpr bool none_fits_anything =
    none_fits<Function, ApplicationType, Object>&& none_fits<Function, ApplicationType, Object, AnyReference>&&
        none_fits<Function, ApplicationType, Object, AnyReference, AnyReference>&&
            none_fits<Function, ApplicationType, Object, AnyReference, AnyReference, AnyReference>;

/// Selects the objects that a function accepts with a value of any type.
template <class Function, class ApplicationType, class Node>
struct WithAnyFunction {
  template <class ObjectType>
  static constexpr bool selects = has_function<Function, ApplicationType, Node, ObjectType, AnyValue>;
};
template <class ApplicationType, class Node>
struct WithAnyFunction<function::Read, ApplicationType, Node> {
  template <class ObjectType>
  static constexpr bool selects = has_function<function::Read, ApplicationType, Node, ObjectType>;
};

/// Whether a list has an object with this index.
template <std::uint16_t Index, class List>
inline constexpr bool has_index = false;
template <std::uint16_t Index, class... Os>
inline constexpr bool has_index<Index, ObjectList<Os...>> = ((Index == Os::index) || ...);

/// Whether a function can be called for an object of this index: a template of an array's elements also fits those with
/// another type or access.
template <class Function, std::uint16_t Index, class List>
inline constexpr bool is_reachable = false;
template <class Function, std::uint16_t Index, class... Os>
inline constexpr bool is_reachable<Function, Index, ObjectList<Os...>> =
    ((Index == Os::index && (std::is_same_v<Function, function::Read> ? readable(Os::access) : writable(Os::access))) ||
     ...);

/// A function `write`, `written` or `read` of an application for one of its objects.
template <class Application, class Function, class Object, bool TypeFits, bool Reachable, bool AnswerFits>
struct ApplicationFunction {
  static constexpr bool is_good = true;
  static_assert(AnswerFits || std::is_same_v<Function, function::Read>,
                "application: write returns an AbortCode, a Result<void> or nothing, and written nothing");
  static_assert(AnswerFits || !std::is_same_v<Function, function::Read>,
                "application: read returns the type of its object, a Result of it, an AbortCode or nothing");
  static_assert(TypeFits, "application: the parameter of this function is not of the type of its object");
  static_assert(Reachable || std::is_same_v<Function, function::Read>,
                "application: the object is ro or const, so that this function can never be called");
  static_assert(Reachable || !std::is_same_v<Function, function::Read>,
                "application: the object is wo, so that this function can never be called");
};

/// The functions of an application with one of these three names.
template <class Device, class Application, class Function, bool None>
struct ApplicationFunctions {
  static constexpr bool is_good = true;
  static_assert(!None, "application: none of these functions has an object of this device and its type as parameters");
};

/// Whether the result of `write` or `written` is one that the node can use.
template <class Function, class ApplicationType, class Node, class ObjectType>
[[nodiscard]] constexpr bool check_answer() {
  if constexpr (!std::is_same_v<Function, function::Read> &&
                has_function<Function, ApplicationType, Node, ObjectType, typename ObjectType::type>) {
    using Answer =
        decltype(call_function<Function>(std::declval<ApplicationType&>(), std::declval<Node&>(),
                                         std::declval<ObjectType>(), std::declval<typename ObjectType::type>()));
    return std::is_void_v<Answer> || (std::is_same_v<Function, function::Write> &&
                                      (std::is_same_v<Answer, AbortCode> || std::is_same_v<Answer, Result<void>>));
  } else {
    return true;
  }
}

/// Selects the objects that a function accepts with other arguments than those of the node.
template <class Function, class ApplicationType, class Called>
struct WithOtherArguments {
  template <class ObjectType>
  static constexpr bool selects =
      !is_listed<ObjectType, Called> && !none_fits_anything<Function, ApplicationType, ObjectType>;
};

template <class Application, class Function>
[[nodiscard]] constexpr Verdict<Passed> check_uncalled(ObjectList<> /*none*/) {
  return {};
}
template <class Application, class Function, class ObjectType, class... Os>
[[nodiscard]] constexpr Verdict<UncalledFunction<Application, Function, ObjectType>> check_uncalled(
    ObjectList<ObjectType, Os...>) {
  return {};
}

/// A function for an object that can be called with any value.
template <class Function, class ApplicationType, class Node, class Exact, class ObjectType>
[[nodiscard]] constexpr auto check_object() {
  constexpr bool fits = has_index<ObjectType::index, Exact>;
  constexpr bool reads = std::is_same_v<Function, function::Read>;
  constexpr bool reachable = !fits || is_reachable<Function, ObjectType::index, Exact>;
  constexpr bool answer_fits = reads ? fits : !fits || check_answer<Function, ApplicationType, Node, ObjectType>();
  constexpr bool passes = (fits || reads) && reachable && answer_fits;
  return VerdictOf<passes,
                   ApplicationFunction<ApplicationType, Function, ObjectType, fits || reads, reachable, answer_fits>>{};
}
template <class Function, class ApplicationType, class Node, class Exact, class... Os>
[[nodiscard]] constexpr auto check_each_object(ObjectList<Os...> /*objects*/) {
  return canopen::first_failure(check_object<Function, ApplicationType, Node, Exact, Os>()...);
}

template <class Device, class Node, class ApplicationType, class Function>
[[nodiscard]] constexpr auto check_objects() {
  if constexpr (!Function::template is_declared<ApplicationType>) {
    return Verdict<Passed>{};
  } else {
    using Objects = typename Device::Objects;
    using Any = SelectObjects<WithAnyFunction<Function, ApplicationType, Node>, Objects>;
    using Exact = SelectObjects<WithFunction<Function, ApplicationType, Node>, Objects>;
    constexpr bool is_for_all = has_function<Function, ApplicationType, Node, NoObject, AnyValue> ||
                                has_function<Function, ApplicationType, Node, NoObject>;
    using None = VerdictOf<Any::size != 0, ApplicationFunctions<Device, ApplicationType, Function, Any::size == 0>>;
    if constexpr (is_for_all) {
      return None{};
    } else if constexpr (!none_fits<Function, ApplicationType, ObjectOfAnother<Device>> ||
                         !none_fits<Function, ApplicationType, ObjectOfAnother<Device>, AnyValue> ||
                         !none_fits<Function, ApplicationType, ObjectOfAnother<Device>, AnyValue, AnyValue>) {
      return Verdict<FunctionOfAnotherDevice<Device, ApplicationType, Function,
                                             typename FirstParameter<Function, ApplicationType>::type>>{};
    } else if constexpr (!none_fits_anything<Function, ApplicationType, UncalledObject<Device, Any>>) {
      return check_uncalled<ApplicationType, Function>(
          SelectObjects<WithOtherArguments<Function, ApplicationType, Any>, Objects>{});
    } else {
      return canopen::first_failure(None{}, check_each_object<Function, ApplicationType, Node, Exact>(Any{}));
    }
  }
}

/// The function of an event.
template <class Application, class Event, class Label, bool Fits, bool Single, bool Exists>
struct ApplicationEvent {
  static constexpr bool is_good = true;
  static_assert(Fits, "application: the parameters of this function do not match its event");
  static_assert(!Fits || Single, "application: a second function of this name can never be called");
  static_assert(Exists, "application: this device does not have the object that this event needs");
};

template <std::uint16_t Index>
struct EventObject {
  static constexpr std::uint16_t index = Index;
  static constexpr std::uint8_t sub_index = 0;
};

/// Converts to references to each type but `Type`.
template <class Type>
struct OtherThan {
  template <class OtherType>
  requires(!std::same_as<std::remove_cv_t<OtherType>, Type>) operator OtherType&()
      const;  // NOLINT(google-explicit-constructor): a value
};

/// `Type` once for each element of a pack of numbers or types.
template <class Type, std::size_t>
using Repeated = Type;

/// Whether no function of an event accepts this number of arguments of any type.
template <class Event, class ApplicationType, std::size_t... Position>
[[nodiscard]] constexpr bool none_with(std::index_sequence<Position...>) {
  return none_fits<Event, ApplicationType, Repeated<AnyReference, Position>...>;
}

/// Whether no function of an event accepts another type than that of the argument `At`.
template <class Event, class ApplicationType, class... Arguments, std::size_t At, std::size_t... Position>
[[nodiscard]] constexpr bool none_with_another(function::ArgumentList<Arguments...>,
                                               std::integral_constant<std::size_t, At>,
                                               std::index_sequence<Position...>) {
  return none_fits<Event, ApplicationType, std::conditional_t<Position == At, OtherThan<Arguments>, AnyReference>...> &&
         none_fits<Event, ApplicationType, std::conditional_t<Position == At, OtherThan<Arguments>, AnyReference>...,
                   AnyReference>;
}

/// Whether an application has no overload of the function of an event that is never called: with other parameters, or
/// both with the node and without it. A template that accepts every type is the only function.
template <class Event, class ApplicationType, class Node, class... Arguments>
[[nodiscard]] constexpr bool is_only(function::ArgumentList<Arguments...> arguments) {
  using Order = std::index_sequence_for<Arguments...>;
  constexpr std::size_t count = sizeof...(Arguments);
  if constexpr (count == 0) {
    constexpr bool without_node = requires(ApplicationType & application) { Event::call(application); };
    constexpr bool with_any = !none_fits<Event, ApplicationType, AnyReference>;
    return !(with_any && without_node) && none_with<Event, ApplicationType>(std::make_index_sequence<2>{});
  } else if constexpr (!none_fits<Event, ApplicationType, Repeated<NoObject, sizeof(Arguments)>...> ||
                       !none_fits<Event, ApplicationType, Repeated<NoObject, sizeof(Arguments)>..., NoObject>) {
    return true;
  } else {
    constexpr bool with_node = requires(ApplicationType & application, Node & node) {
      Event::call(application, std::declval<Exactly<Arguments>&>()..., node);
    };
    constexpr bool without_node = requires(ApplicationType & application) {
      Event::call(application, std::declval<Exactly<Arguments>&>()...);
    };
    return !(with_node && without_node) && none_with<Event, ApplicationType>(std::make_index_sequence<count - 1>{}) &&
           none_with<Event, ApplicationType>(std::make_index_sequence<count + 2>{})&& [&]<std::size_t... At>(
               std::index_sequence<At...>) {
      return (
          none_with_another<Event, ApplicationType>(arguments, std::integral_constant<std::size_t, At>{}, Order{}) &&
          ...);
    }
    (Order{});
  }
}
template <class Event, class ApplicationType, class Node>
inline constexpr bool is_only_function = is_only<Event, ApplicationType, Node>(typename Event::Arguments{});

template <class Device, class Node, class ApplicationType, class Event>
[[nodiscard]] constexpr auto check_event() {
  if constexpr (!Event::template is_declared<ApplicationType>) {
    return Verdict<Passed>{};
  } else {
    constexpr bool fits = has_event<Event, ApplicationType, Node>;
    constexpr bool single = is_only_function<Event, ApplicationType, Node>;
    constexpr bool exists = Event::object == 0 || Device::dictionary.has(Event::object, 0);
    constexpr bool passes = fits && single && exists;
    using Label = pdo_detail::LabelOf<EventObject<Event::object>>;
    return VerdictOf<passes, ApplicationEvent<ApplicationType, Event, Label, fits, single, exists>>{};
  }
}

/// The functions `every` of an application: whether each of them has a period as its first parameter.
template <class Application, bool HavePeriods>
struct PeriodicFunctions {
  static constexpr bool is_good = true;
  static_assert(HavePeriods,
                "application: the first parameter of every is a period such as canopen::Milliseconds<10>, and the node "
                "is the only other one");
};

/// One of them.
template <class Application, class Period, bool Fits, bool Single, bool ReturnsNothing>
struct PeriodicFunction {
  static constexpr bool is_good = true;
  static_assert(Fits, "application: the node calls every with (period) or (period, node); it is auto& node");
  static_assert(!Fits || Single, "application: a second function every of this period can never be called");
  static_assert(!Fits || !Single || ReturnsNothing, "application: every returns nothing");
};

template <class ApplicationType, class Node, class PeriodType>
[[nodiscard]] constexpr auto check_period() {
  constexpr bool without_node = !none_fits<function::Every, ApplicationType, PeriodType>;
  constexpr bool with_any = !none_fits<function::Every, ApplicationType, PeriodType, AnyReference>;
  constexpr bool fits = has_function<function::Every, ApplicationType, Node, PeriodType>;
  constexpr bool returns_nothing = [] {
    if constexpr (fits) {
      return std::is_void_v<decltype(call_function<function::Every>(
          std::declval<ApplicationType&>(), std::declval<Node&>(), std::declval<PeriodType>()))>;
    } else {
      return false;
    }
  }();
  constexpr bool single = !(with_any && without_node);
  constexpr bool passes = fits && single && returns_nothing;
  return VerdictOf<passes, PeriodicFunction<ApplicationType, PeriodType, fits, single, returns_nothing>>{};
}

template <class ApplicationType, class Node>
[[nodiscard]] constexpr auto check_periods() {
  using function::Every;
  if constexpr (!Every::template is_declared<ApplicationType>) {
    return Verdict<Passed>{};
  } else {
    constexpr bool without_period = requires(ApplicationType & application) { Every::call(application); };
    // A template of periods, which the search does not find, accepts each period.
    using Unlikely = Microseconds<1'799'999'983>;
    constexpr bool for_all = takes_first<Every, ApplicationType, Unlikely> &&
                             !takes_first<Every, ApplicationType, PeriodIn<1'799'999'983, 1'799'999'983>>;
    constexpr bool others = without_period || for_all || takes_first<Every, ApplicationType, NoPeriod> ||
                            !none_fits<Every, ApplicationType, AnyReference, AnyReference, AnyReference>;
    constexpr bool have_periods = takes_first<Every, ApplicationType, AnyPeriod> && !others;
    constexpr auto check_each = []<class... PeriodType>(PeriodList<PeriodType...>) {
      return canopen::first_failure(check_period<ApplicationType, Node, PeriodType>()...);
    };
    return canopen::first_failure(VerdictOf<have_periods, PeriodicFunctions<ApplicationType, have_periods>>{},
                                  check_each(periods_of_application<ApplicationType>()));
  }
}

/// A function with a name that the node does not call, but that resembles one that it calls.
template <class Application, class Meant>
struct MisspeltFunction {
  static constexpr bool is_good = true;
  static_assert(!Meant::template is_declared<Application>,
                "application: the node does not call a function of this name; canopen/node/functions.hpp lists those "
                "that it calls, such as write, written, read and on_state");
};

/// The same for names that an application may use for something else: its function has a period, or the parameters
/// `(node, TimePoint)` of a function that was called each millisecond.
template <class Application, class Name, bool IsPeriodic>
struct MisspeltPeriodicFunction {
  static constexpr bool is_good = true;
  static_assert(
      !IsPeriodic,
      "application: the node does not call a function of this name; write void every(canopen::Milliseconds<1>, "
      "auto& node), with its period");
};

template <class Function, class ApplicationType, class... Values>
inline constexpr bool is_callable_with = requires(ApplicationType& application, Values... values) {
  Function::call(application, values...);
};

template <class ApplicationType, class Name>
[[nodiscard]] constexpr bool is_periodic() {
  constexpr bool has_period =
      (is_callable_with<Name, ApplicationType, AnyPeriod> && !is_callable_with<Name, ApplicationType, NoPeriod>) ||
      (is_callable_with<Name, ApplicationType, AnyPeriod, AnyReference> &&
       !is_callable_with<Name, ApplicationType, NoPeriod, AnyReference>);
  return has_period ||
         (std::is_same_v<Name, function::Tick> && is_callable_with<Name, ApplicationType, AnyReference, TimePoint>);
}

template <class ApplicationType, class... Names>
[[nodiscard]] constexpr auto check_periodic_names() {
  return canopen::first_failure(
      VerdictOf<!is_periodic<ApplicationType, Names>(), MisspeltPeriodicFunction<ApplicationType, Names, true>>{}...);
}

/// Checks that a class does not have the function `tick(node, TimePoint)`, which no node calls.
template <class ApplicationType>
[[nodiscard]] constexpr auto check_tick() {
  if constexpr (std::is_class_v<ApplicationType> && !std::is_final_v<ApplicationType>) {
    return check_periodic_names<ApplicationType, function::Tick>();
  } else {
    return Verdict<Passed>{};
  }
}

template <class ApplicationType, class... Names>
[[nodiscard]] constexpr auto check_names() {
  return canopen::first_failure(
      VerdictOf<!Names::template is_declared<ApplicationType>, MisspeltFunction<ApplicationType, Names>>{}...);
}

template <class Device, class Node, class ApplicationType>
[[nodiscard]] constexpr auto check_application() {
  using namespace function;
  return canopen::first_failure(
      check_names<ApplicationType, Writen, OnWrite, OnWritten, OnRead, OnNmtState, OnEmcy, OnPdo, OnChange, OnChanged,
                  OnUpdate, OnReceive, OnReceived, OnStateChange, OnNmt, OnHeartBeat, OnNodeGuarding, OnErrors, Wrote,
                  Wirte, OnStart, OnEvery, OnTick, OnTimer>(),
      check_periodic_names<ApplicationType, Tick, Evry, Each, Periodic, OnTime>(),
      check_periods<ApplicationType, Node>(), check_event<Device, Node, ApplicationType, Start>(),
      check_objects<Device, Node, ApplicationType, Write>(), check_objects<Device, Node, ApplicationType, Written>(),
      check_objects<Device, Node, ApplicationType, Read>(), check_event<Device, Node, ApplicationType, OnState>(),
      check_event<Device, Node, ApplicationType, OnSync>(), check_event<Device, Node, ApplicationType, OnTimeOfDay>(),
      check_event<Device, Node, ApplicationType, OnHeartbeat>(),
      check_event<Device, Node, ApplicationType, OnLifeGuarding>(),
      check_event<Device, Node, ApplicationType, OnEmergency>(), check_event<Device, Node, ApplicationType, OnError>(),
      check_event<Device, Node, ApplicationType, OnRpdo>(),
      check_event<Device, Node, ApplicationType, OnStoredValue>());
}

}  // namespace canopen::handler_detail
