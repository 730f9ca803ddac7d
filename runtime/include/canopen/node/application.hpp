/// The application of a device as a class: the node calls those functions that the class has.
///
///     struct Pump {
///       canopen::Result<void> write(od::speed_setpoint, std::uint16_t speed) {  // before it is stored
///         return speed <= max_speed ? canopen::ok : canopen::AbortCode::value_too_high;
///       }
///       void written(od::speed_setpoint, std::uint16_t speed, auto& node) {     // after it has been stored
///         node.set(od::pressure{}, static_cast<std::uint16_t>(speed / 4));
///       }
///       std::uint16_t read(od::temperature) { return measure(); }               // before it is sent
///       void on_state(canopen::NmtState state) { show(state); }
///       void start(auto& node) { node.set(od::pressure{}, 0); }                 // at power-on
///       void every(canopen::Milliseconds<10>, auto& node) { regulate(node); }   // each 10 ms
///     };
///     canopen::Node<pump::Device, Bus, Pump> node{bus, canopen::NodeId{5}};
///
/// node/functions.hpp lists the functions. Each may have the node as an additional last argument, and must name its
/// result type, because the node is not yet complete where the compiler looks for the functions. A template of an
/// array's elements is one function for all of them: `template <std::uint8_t I> void written(od::outputs<I>,
/// std::uint8_t)`. A function that the node would never call does not compile: node/application_check.hpp.
#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/handled.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/node/mailbox.hpp"
#include "canopen/node/periodic_functions.hpp"
#include "canopen/od/object_list.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

/// An application that is not a part of its node; it must outlive the node.
template <class A>
struct ApplicationAt {
  A* application;
};
template <class A>
[[nodiscard]] constexpr ApplicationAt<A> application_at(A& application) {
  return {&application};
}

namespace handler_detail {

template <class H>
inline constexpr bool is_access_handler = false;
template <class O, class F>
inline constexpr bool is_access_handler<WriteHandler<O, F>> = true;
template <class O, class F>
inline constexpr bool is_access_handler<WrittenHandler<O, F>> = true;
template <class O, class F>
inline constexpr bool is_access_handler<ReadHandler<O, F>> = true;

template <class H>
inline constexpr bool is_periodic_handler = false;
template <class P, class F>
inline constexpr bool is_periodic_handler<PeriodicHandler<P, F>> = true;

template <class H>
inline constexpr bool is_event_handler = false;
template <class Event, class F>
inline constexpr bool is_event_handler<EventHandler<Event, F>> = true;

/// Whether a type is one of the handlers with a template of their own.
template <class H>
inline constexpr bool is_handler =
    is_access_handler<H> || is_event_handler<H> || is_periodic_handler<H> || domain_detail::is_reader<H> ||
    domain_detail::is_writer<H> || storage_detail::is_stored_in<H> || lss_detail::is_handler<H> ||
    mailbox_detail::is_values_from<H> || domain_detail::is_bound_to<H>;

/// The class of an application, which a node has as a handler; any other type for a handler.
template <class H>
struct ApplicationOf {
  using type = H;
  static constexpr H& get(H& application) { return application; }
};
template <class A>
struct ApplicationOf<ApplicationAt<A>> {
  using type = A;
  static constexpr A& get(const ApplicationAt<A>& at) { return *at.application; }
};

/// Whether a class has any function with one of these names.
template <class A, class... Functions>
inline constexpr bool declares_any = (Functions::template is_declared<A> || ...);

template <class A, bool may_be = std::is_class_v<A> && !std::is_final_v<A> && !is_handler<A>>
inline constexpr bool is_application = false;
template <class A>
inline constexpr bool is_application<A, true> =
    declares_any<A, function::Write, function::Written, function::Read, function::Start, function::Every,
                 function::OnState, function::OnSync, function::OnTimeOfDay, function::OnHeartbeat,
                 function::OnLifeGuarding, function::OnEmergency, function::OnError, function::OnRpdo,
                 function::OnStoredValue>;

/// The periods of a handler.
template <class H>
struct PeriodsOf {
  using type = PeriodList<>;
};
template <class P, class F>
struct PeriodsOf<PeriodicHandler<P, F>> {
  using type = PeriodList<P>;
};
template <class H>
requires is_application<typename ApplicationOf<H>::type>
struct PeriodsOf<H> {
  using type = decltype(periods_of_application<typename ApplicationOf<H>::type>());
};

/// Whether a handler is called for an event: an application that has its function, or a callable.
template <class Event, class H>
inline constexpr bool has_event_function = false;
template <class Event, class F>
inline constexpr bool has_event_function<Event, EventHandler<Event, F>> = true;
template <class Event, class H>
requires is_application<typename ApplicationOf<H>::type>
inline constexpr bool has_event_function<Event, H> = Event::template is_declared<typename ApplicationOf<H>::type>;

/// Whether an application has a function for these arguments, with or without the node after them.
template <class Function, class A, class Node, class... Values>
inline constexpr bool has_function = requires(A& application, Node& node, Values... values) {
  Function::call(application, values...);
}
|| requires(A& application, Node& node, Values... values) { Function::call(application, values..., node); };

/// Calls it.
template <class Function, class A, class Node, class... Values>
constexpr decltype(auto) call_function(A& application, [[maybe_unused]] Node& node, const Values&... values) {
  if constexpr (requires { Function::call(application, values...); }) {
    return Function::call(application, values...);
  } else {
    return Function::call(application, values..., node);
  }
}

/// Converts to `T` alone: a parameter of another type, to which `T` would be converted, does not accept it.
template <class T>
struct Exactly {
  template <std::same_as<T> U>
  operator U() const;  // NOLINT(google-explicit-constructor): stands for a value
};

/// Selects the objects with a function of the application.
template <class Function, class A, class Node>
struct WithFunction {
  template <class O>
  static constexpr bool selects = has_function<Function, A, Node, O, Exactly<typename O::type>>;
};
/// Whether `read` returns a value of an object, nothing or an abort code. A template of an array's elements also fits
/// sub-index 0, which has another type.
template <class A, class Node, class O, bool exists = has_function<function::Read, A, Node, O>>
inline constexpr bool supplies = false;
template <class A, class Node, class O>
inline constexpr bool supplies<A, Node, O, true> = [] {
  using Answer = decltype(call_function<function::Read>(std::declval<A&>(), std::declval<Node&>(), std::declval<O>()));
  return std::is_void_v<Answer> || std::is_same_v<Answer, AbortCode> || std::is_same_v<Answer, typename O::type> ||
         std::is_same_v<Answer, Result<typename O::type>>;
}();

template <class A, class Node>
struct WithFunction<function::Read, A, Node> {
  template <class O>
  static constexpr bool selects = supplies<A, Node, O>;
};

/// The objects of a device for which an application has a function.
template <class Device, class Node, class A, class Function, bool declared = Function::template is_declared<A>>
struct ObjectsWith {
  using type = ObjectList<>;
};
template <class Device, class Node, class A, class Function>
struct ObjectsWith<Device, Node, A, Function, true> {
  using type = SelectObjects<WithFunction<Function, A, Node>, typename Device::Objects>;
};

template <class Event, class A, class Node, class Arguments = typename Event::Arguments>
inline constexpr bool has_event = false;
template <class Event, class A, class Node, class... Arguments>
inline constexpr bool has_event<Event, A, Node, function::ArgumentList<Arguments...>> =
    has_function<Event, A, Node, Exactly<Arguments>...>;

template <class Device, class Node, class H>
requires is_application<typename ApplicationOf<H>::type>
struct Handled<Device, Node, H> {
  using Application = typename ApplicationOf<H>::type;
  using BeforeWrite = typename ObjectsWith<Device, Node, Application, function::Write>::type;
  using AfterWrite = typename ObjectsWith<Device, Node, Application, function::Written>::type;
  using Read = typename ObjectsWith<Device, Node, Application, function::Read>::type;
  template <class Event>
  static constexpr bool has_event_function = has_event<Event, Application, Node>;

  template <DictionaryObject O>
  static constexpr AbortCode before_write(H& handler, Node& node, const typename O::type& value) {
    return code_of([&]() -> decltype(auto) {
      return call_function<function::Write>(ApplicationOf<H>::get(handler), node, O{}, value);
    });
  }
  template <DictionaryObject O>
  static constexpr void after_write(H& handler, Node& node, const typename O::type& value) {
    call_function<function::Written>(ApplicationOf<H>::get(handler), node, O{}, value);
  }
  template <DictionaryObject O>
  static constexpr AbortCode read(H& handler, Node& node) {
    return supply<O>(node, [&]() -> decltype(auto) {
      return call_function<function::Read>(ApplicationOf<H>::get(handler), node, O{});
    });
  }
  template <class Event, class... Arguments>
  static constexpr void notify([[maybe_unused]] H& handler, [[maybe_unused]] Node& node,
                               [[maybe_unused]] const Arguments&... arguments) {
    if constexpr (has_function<Event, Application, Node, Exactly<Arguments>...>)
      call_function<Event>(ApplicationOf<H>::get(handler), node, arguments...);
  }
  template <class P>
  static constexpr void every(H& handler, Node& node) {
    call_function<function::Every>(ApplicationOf<H>::get(handler), node, P{});
  }
};

}  // namespace handler_detail
}  // namespace canopen
