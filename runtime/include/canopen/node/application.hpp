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
#include "canopen/node/periodic_functions.hpp"
#include "canopen/node/values_from.hpp"
#include "canopen/od/object_list.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

/// An application that is not a part of its node; it must outlive the node.
template <class ApplicationType>
struct ApplicationAt {
  ApplicationType* application;
};
template <class ApplicationType>
[[nodiscard]] constexpr ApplicationAt<ApplicationType> application_at(ApplicationType& application) {
  return {&application};
}

namespace handler_detail {

template <class Handler>
inline constexpr bool is_access_handler = false;
template <class Object, class Callable>
inline constexpr bool is_access_handler<WriteHandler<Object, Callable>> = true;
template <class Object, class Callable>
inline constexpr bool is_access_handler<WrittenHandler<Object, Callable>> = true;
template <class Object, class Callable>
inline constexpr bool is_access_handler<ReadHandler<Object, Callable>> = true;

template <class Handler>
inline constexpr bool is_periodic_handler = false;
template <class PeriodType, class Callable>
inline constexpr bool is_periodic_handler<PeriodicHandler<PeriodType, Callable>> = true;

template <class Handler>
inline constexpr bool is_event_handler = false;
template <class Event, class Callable>
inline constexpr bool is_event_handler<EventHandler<Event, Callable>> = true;

/// Whether a type is one of the handlers with a template of their own.
template <class Handler>
inline constexpr bool is_handler =
    is_access_handler<Handler> || is_event_handler<Handler> || is_periodic_handler<Handler> ||
    domain_detail::is_reader<Handler> || domain_detail::is_writer<Handler> || storage_detail::is_stored_in<Handler> ||
    lss_detail::is_handler<Handler> || mailbox_detail::is_values_from<Handler> || domain_detail::is_bound_to<Handler>;

/// The class of an application, which a node has as a handler; any other type for a handler.
template <class Handler>
struct ApplicationOf {
  using type = Handler;
  static constexpr Handler& get(Handler& application) { return application; }
};
template <class ApplicationType>
struct ApplicationOf<ApplicationAt<ApplicationType>> {
  using type = ApplicationType;
  static constexpr ApplicationType& get(const ApplicationAt<ApplicationType>& at) { return *at.application; }
};

/// Whether a class has any function with one of these names.
template <class ApplicationType, class... Functions>
inline constexpr bool declares_any = (Functions::template is_declared<ApplicationType> || ...);

template <class ApplicationType, bool may_be = std::is_class_v<ApplicationType> && !std::is_final_v<ApplicationType> &&
                                               !is_handler<ApplicationType>>
inline constexpr bool is_application = false;
template <class ApplicationType>
inline constexpr bool is_application<ApplicationType, true> =
    declares_any<ApplicationType, function::Write, function::Written, function::Read, function::Start, function::Every,
                 function::OnState, function::OnSync, function::OnTimeOfDay, function::OnHeartbeat,
                 function::OnLifeGuarding, function::OnEmergency, function::OnError, function::OnRpdo,
                 function::OnStoredValue>;

/// The periods of a handler.
template <class Handler>
struct PeriodsOf {
  using type = PeriodList<>;
};
template <class PeriodType, class Callable>
struct PeriodsOf<PeriodicHandler<PeriodType, Callable>> {
  using type = PeriodList<PeriodType>;
};
template <class Handler>
requires is_application<typename ApplicationOf<Handler>::type>
struct PeriodsOf<Handler> {
  using type = decltype(periods_of_application<typename ApplicationOf<Handler>::type>());
};

/// Whether a handler is called for an event: an application that has its function, or a callable.
template <class Event, class Handler>
inline constexpr bool has_event_function = false;
template <class Event, class Callable>
inline constexpr bool has_event_function<Event, EventHandler<Event, Callable>> = true;
template <class Event, class Handler>
requires is_application<typename ApplicationOf<Handler>::type>
inline constexpr bool has_event_function<Event, Handler> =
    Event::template is_declared<typename ApplicationOf<Handler>::type>;

/// Whether an application has a function for these arguments, with or without the node after them.
template <class Function, class ApplicationType, class Node, class... Values>
inline constexpr bool has_function = requires(ApplicationType& application, Node& node, Values... values) {
  Function::call(application, values...);
}
|| requires(ApplicationType& application, Node& node, Values... values) {
  Function::call(application, values..., node);
};

/// Calls it.
template <class Function, class ApplicationType, class Node, class... Values>
constexpr decltype(auto) call_function(ApplicationType& application, [[maybe_unused]] Node& node,
                                       const Values&... values) {
  if constexpr (requires { Function::call(application, values...); }) {
    return Function::call(application, values...);
  } else {
    return Function::call(application, values..., node);
  }
}

/// Converts to `Type` alone: a parameter of another type, to which `Type` would be converted, does not accept it.
template <class Type>
struct Exactly {
  template <std::same_as<Type> OtherType>
  operator OtherType() const;  // NOLINT(google-explicit-constructor): stands for a value
};

/// Selects the objects with a function of the application.
template <class Function, class ApplicationType, class Node>
struct WithFunction {
  template <class Object>
  static constexpr bool selects = has_function<Function, ApplicationType, Node, Object, Exactly<typename Object::type>>;
};
/// Whether `read` returns a value of an object, nothing or an abort code. A template of an array's elements also fits
/// sub-index 0, which has another type.
template <class ApplicationType, class Node, class Object,
          bool exists = has_function<function::Read, ApplicationType, Node, Object>>
inline constexpr bool supplies = false;
template <class ApplicationType, class Node, class Object>
inline constexpr bool supplies<ApplicationType, Node, Object, true> = [] {
  using Answer = decltype(call_function<function::Read>(std::declval<ApplicationType&>(), std::declval<Node&>(),
                                                        std::declval<Object>()));
  return std::is_void_v<Answer> || std::is_same_v<Answer, AbortCode> || std::is_same_v<Answer, typename Object::type> ||
         std::is_same_v<Answer, Result<typename Object::type>>;
}();

template <class ApplicationType, class Node>
struct WithFunction<function::Read, ApplicationType, Node> {
  template <class Object>
  static constexpr bool selects = supplies<ApplicationType, Node, Object>;
};

/// The objects of a device for which an application has a function.
template <class Device, class Node, class ApplicationType, class Function,
          bool declared = Function::template is_declared<ApplicationType>>
struct ObjectsWith {
  using type = ObjectList<>;
};
template <class Device, class Node, class ApplicationType, class Function>
struct ObjectsWith<Device, Node, ApplicationType, Function, true> {
  using type = SelectObjects<WithFunction<Function, ApplicationType, Node>, typename Device::Objects>;
};

template <class Event, class ApplicationType, class Node, class Arguments = typename Event::Arguments>
inline constexpr bool has_event = false;
template <class Event, class ApplicationType, class Node, class... Arguments>
inline constexpr bool has_event<Event, ApplicationType, Node, function::ArgumentList<Arguments...>> =
    has_function<Event, ApplicationType, Node, Exactly<Arguments>...>;

template <class Device, class Node, class Handler>
requires is_application<typename ApplicationOf<Handler>::type>
struct Handled<Device, Node, Handler> : HandlesNothing {
  using Application = typename ApplicationOf<Handler>::type;
  using BeforeWrite = typename ObjectsWith<Device, Node, Application, function::Write>::type;
  using AfterWrite = typename ObjectsWith<Device, Node, Application, function::Written>::type;
  using Read = typename ObjectsWith<Device, Node, Application, function::Read>::type;
  template <class Event>
  static constexpr bool has_event_function = has_event<Event, Application, Node>;

  template <DictionaryObject Object>
  static constexpr AbortCode before_write(Handler& handler, Node& node, const typename Object::type& value) {
    return code_of([&]() -> decltype(auto) {
      return call_function<function::Write>(ApplicationOf<Handler>::get(handler), node, Object{}, value);
    });
  }
  template <DictionaryObject Object>
  static constexpr void after_write(Handler& handler, Node& node, const typename Object::type& value) {
    call_function<function::Written>(ApplicationOf<Handler>::get(handler), node, Object{}, value);
  }
  template <DictionaryObject Object>
  static constexpr AbortCode read(Handler& handler, Node& node) {
    return supply<Object>(node, [&]() -> decltype(auto) {
      return call_function<function::Read>(ApplicationOf<Handler>::get(handler), node, Object{});
    });
  }
  template <class Event, class... Arguments>
  static constexpr void notify([[maybe_unused]] Handler& handler, [[maybe_unused]] Node& node,
                               [[maybe_unused]] const Arguments&... arguments) {
    if constexpr (has_function<Event, Application, Node, Exactly<Arguments>...>)
      call_function<Event>(ApplicationOf<Handler>::get(handler), node, arguments...);
  }
  template <class PeriodType>
  static constexpr void every(Handler& handler, Node& node) {
    call_function<function::Every>(ApplicationOf<Handler>::get(handler), node, PeriodType{});
  }
};

}  // namespace handler_detail
}  // namespace canopen
