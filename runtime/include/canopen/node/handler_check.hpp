/// Checks the handlers of a node at its declaration: a handler that can never be called does not compile. The
/// compiler's message names the object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/label.hpp"
#include "canopen/base/result.hpp"
#include "canopen/base/verdict.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/application_check.hpp"
#include "canopen/node/composition.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/node/values_from.hpp"
#include "canopen/od/device_object.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

namespace handler_detail {

template <class HandlerType, bool IsFinal>
struct KnownHandler {
  static constexpr bool is_good = true;
  static_assert(is_handler<HandlerType> || !IsFinal,
                "application: the class is final; without `final` it can be one: a derived class finds its functions");
  static_assert(
      is_handler<HandlerType> || IsFinal,
      "not a handler: pass on_write(object, ...), on_read(object, ...), on_state(...) or another on_...(), or "
      "an application, a class with functions of canopen/node/functions.hpp; a node-ID is NodeId{n}");
};

/// The event that a handler is called for.
enum class Called : std::uint8_t { by_service, on_upload, on_download, after_download };

template <class HandlerType>
inline constexpr Called called = Called::by_service;
template <class ObjectType, class Function>
inline constexpr Called called<ReadHandler<ObjectType, Function>> = Called::on_upload;
template <class ObjectType, class Function>
inline constexpr Called called<DomainReadHandler<ObjectType, Function>> = Called::on_upload;
template <class ObjectType, class Function>
inline constexpr Called called<WriteHandler<ObjectType, Function>> = Called::on_download;
template <class ObjectType, class Function>
inline constexpr Called called<WrittenHandler<ObjectType, Function>> = Called::after_download;
template <class ObjectType, class Function>
inline constexpr Called called<DomainWriteHandler<ObjectType, Function>> = Called::on_download;

/// Whether two handlers are called for the same event of the same object.
template <class HandlerType, class Other>
[[nodiscard]] constexpr bool is_same_call() {
  if constexpr (called<HandlerType> == called<Other> && called<HandlerType> != Called::by_service) {
    return HandlerType::object::index == Other::object::index &&
           HandlerType::object::sub_index == Other::object::sub_index;
  } else {
    return false;
  }
}

/// The handlers of one object: the event they are called for, and what is wrong with them.
template <class Object, class Label, Called When, bool Exists, bool IsForeign, bool Reachable, std::size_t Count>
struct ObjectHandler {
  static constexpr bool is_good = true;
  static_assert(Exists, "handler: this device does not have the object");
  static_assert(!IsForeign, "handler: this is an object of another device; this device has another one at its index");
  static_assert(!Exists || IsForeign || Reachable || When == Called::on_upload,
                "on_write: the object is ro or const, so that the handler can never be called");
  static_assert(!Exists || IsForeign || Reachable || When != Called::on_upload,
                "on_read: the object is wo, so that the handler can never be called");
  static_assert(Count == 1, "handler: the object has two of them; join them to one");
};

template <class Device, class HandlerType, class... Handlers>
[[nodiscard]] constexpr auto check_object_handler() {
  using Object = typename HandlerType::object;
  constexpr entry::Word word = Device::dictionary.find(Object::index, Object::sub_index);
  constexpr bool exists = word > Dictionary::no_sub_index;
  constexpr bool is_foreign = exists && is_of_another_device<Object, Device>;
  constexpr bool reachable =
      (word & (called<HandlerType> == Called::on_upload ? entry::readable : entry::writable)) != 0;
  constexpr std::size_t count = (std::size_t{is_same_call<HandlerType, Handlers>()} + ...);
  constexpr bool passes = exists && !is_foreign && reachable && count == 1;
  return VerdictOf<passes, ObjectHandler<Object, pdo_detail::LabelOf<Object>, called<HandlerType>, exists, is_foreign,
                                         reachable, count>>{};
}

/// The objects without which a service never calls its handler. Handlers of error control are accepted by each device:
/// code that several devices share passes those of heartbeat and of guarding, of which a device may have one.
template <class HandlerType, class Event>
inline constexpr bool is_of = false;
template <class Event, class Function>
inline constexpr bool is_of<EventHandler<Event, Function>, Event> = true;

template <class HandlerType, bool HasObject>
struct ServiceHandler {
  static constexpr bool is_good = true;
  static_assert(!is_of<HandlerType, function::OnSync> || HasObject,
                "on_sync: this device does not have 1005h, so that the handler can never be called");
  static_assert(!is_of<HandlerType, function::OnTimeOfDay> || HasObject,
                "on_time_of_day: this device does not have 1012h, so that the handler can never be called");
  static_assert(!is_of<HandlerType, function::OnEmergency> || HasObject,
                "on_emergency: this device does not have 1028h, so that the handler can never be called");
};

template <class Device, class HandlerType>
[[nodiscard]] constexpr auto check_service_handler() {
  constexpr auto index = is_of<HandlerType, function::OnSync>        ? std::uint16_t{0x1005}
                         : is_of<HandlerType, function::OnTimeOfDay> ? std::uint16_t{0x1012}
                         : is_of<HandlerType, function::OnEmergency> ? std::uint16_t{0x1028}
                                                                     : std::uint16_t{0};
  constexpr bool has_object = index == 0 || Device::dictionary.has(index, 0);
  constexpr bool is_final = std::is_final_v<typename ApplicationOf<HandlerType>::type>;
  return canopen::first_failure(check_tick<typename ApplicationOf<HandlerType>::type>(),
                                VerdictOf<is_handler<HandlerType>, KnownHandler<HandlerType, is_final>>{},
                                VerdictOf<has_object, ServiceHandler<HandlerType, has_object>>{});
}

/// An object of a mailbox.
template <class Object, class Label, bool Exists, bool IsForeign>
struct MailboxObject {
  static constexpr bool is_good = true;
  static_assert(Exists, "values_from: this device does not have an object of the mailbox");
  static_assert(!IsForeign,
                "values_from: the mailbox has an object of another device; this one has another at its index");
};

template <class Device, class HandlerType>
[[nodiscard]] constexpr Verdict<Passed> check_mailbox(std::type_identity<HandlerType> /*handler*/) {
  return {};
}
template <class Device, class Object>
[[nodiscard]] constexpr auto check_mailbox_object() {
  constexpr bool exists = is_in_dictionary<Object, Device>;
  constexpr bool is_foreign = exists && is_of_another_device<Object, Device>;
  constexpr bool passes = exists && !is_foreign;
  return VerdictOf<passes, MailboxObject<Object, pdo_detail::LabelOf<Object>, exists, is_foreign>>{};
}
template <class Device, class... Objects>
[[nodiscard]] constexpr auto check_mailbox(std::type_identity<ValuesFrom<Mailbox<Objects...>>> /*handler*/) {
  return canopen::first_failure(check_mailbox_object<Device, Objects>()...);
}

template <class Device, class Node, class HandlerType, class... Handlers>
[[nodiscard]] constexpr auto check_handler() {
  using Application = typename ApplicationOf<HandlerType>::type;
  if constexpr (composition_detail::is_omits<HandlerType> || composition_detail::is_without<HandlerType>) {
    return Verdict<Passed>{};  // node/composition.hpp
  } else if constexpr (is_application<Application>) {
    return check_application<Device, Node, Application>();
  } else if constexpr (called<HandlerType> != Called::by_service) {
    return check_object_handler<Device, HandlerType, Handlers...>();
  } else {
    return canopen::first_failure(handler_detail::check_mailbox<Device>(std::type_identity<HandlerType>{}),
                                  check_service_handler<Device, HandlerType>());
  }
}

template <class Device, class Node, class... Handlers>
[[nodiscard]] constexpr auto check_handlers() {
  return canopen::first_failure(check_handler<Device, Node, Handlers, Handlers...>()...);
}

}  // namespace handler_detail

/// A class with `is_good`, which does not compile if one of these handlers can never be called in a node of this
/// device. `Node` may be incomplete.
template <class Device, class Node, class... Handlers>
using CheckedHandlers = typename decltype(handler_detail::check_handlers<Device, Node, Handlers...>())::type;

namespace handler_detail {

/// The last parameter of a callable that is not a template; `void` for others.
template <class... Parameters>
struct LastOf {
  using type = void;
};
template <class First, class... Others>
struct LastOf<First, Others...> {
  using type = std::tuple_element_t<sizeof...(Others), std::tuple<First, Others...>>;
};
template <class Result, class Class, class... Parameters>
LastOf<Parameters...> last_of(Result (Class::*)(Parameters...));
template <class Result, class Class, class... Parameters>
LastOf<Parameters...> last_of(Result (Class::*)(Parameters...) const);
template <class Result, class... Parameters>
LastOf<Parameters...> last_of(Result (*)(Parameters...));
template <class Function>
struct LastParameter {
  using type = void;
};
template <class Function>
requires requires { last_of(&Function::operator()); }
struct LastParameter<Function> : decltype(last_of(&Function::operator())) {};
template <class Function>
requires requires(Function function) { last_of(function); }
struct LastParameter<Function> : decltype(last_of(std::declval<Function>())) {};

/// Whether a handler accepts all values of an object: a parameter of a narrower type does not.
template <class ObjectType, class Function>
[[nodiscard]] constexpr bool takes_all_values() {
  using Parameter = std::remove_cvref_t<typename LastParameter<Function>::type>;
  if constexpr (std::is_arithmetic_v<Parameter> && std::is_arithmetic_v<typename ObjectType::type>) {
    return FitsInto<typename ObjectType::type, Parameter>;
  } else {
    return true;
  }
}

template <class HandlerType>
inline constexpr bool takes_all_of = true;
template <class ObjectType, class Function>
inline constexpr bool takes_all_of<WriteHandler<ObjectType, Function>> = takes_all_values<ObjectType, Function>();
template <class ObjectType, class Function>
inline constexpr bool takes_all_of<WrittenHandler<ObjectType, Function>> = takes_all_values<ObjectType, Function>();

template <class Type>
struct ValueIn {
  using type = Type;
};
template <class Type>
struct ValueIn<Result<Type>> {
  using type = Type;
};

/// Whether a read handler returns a value that fits into its object.
template <class ObjectType, class Answer>
[[nodiscard]] constexpr bool fits_into_object() {
  using Value = typename ValueIn<std::remove_cvref_t<Answer>>::type;
  if constexpr (std::is_void_v<Answer> || std::is_same_v<Value, AbortCode>) {
    return true;
  } else if constexpr (std::is_arithmetic_v<typename ObjectType::type>) {
    return FitsInto<Value, typename ObjectType::type>;
  } else {
    return std::is_convertible_v<Value, typename ObjectType::type> || TextFor<Value, ObjectType>;
  }
}
template <class Node, class HandlerType>
inline constexpr bool supplies_value = true;
template <class Node, class ObjectType, class Function>
inline constexpr bool supplies_value<Node, ReadHandler<ObjectType, Function>> = [] {
  if constexpr (std::is_invocable_v<Function&>) return fits_into_object<ObjectType, std::invoke_result_t<Function&>>();
  if constexpr (!std::is_invocable_v<Function&> && std::is_invocable_v<Function&, Node&>)
    return fits_into_object<ObjectType, std::invoke_result_t<Function&, Node&>>();
  return true;
}();

template <class Node, class HandlerType>
inline constexpr bool parameters_fit = true;
template <class Node, class ObjectType, class Function>
inline constexpr bool parameters_fit<Node, WriteHandler<ObjectType, Function>> =
    takes<Function, Node, typename ObjectType::type>;
template <class Node, class ObjectType, class Function>
inline constexpr bool parameters_fit<Node, WrittenHandler<ObjectType, Function>> =
    takes<Function, Node, typename ObjectType::type>;
template <class Node, class ObjectType, class Function>
inline constexpr bool parameters_fit<Node, ReadHandler<ObjectType, Function>> = takes<Function, Node>;
template <class Node, class PeriodType, class Function>
inline constexpr bool parameters_fit<Node, PeriodicHandler<PeriodType, Function>> = takes<Function, Node>;
template <class Function, class Node, class List>
inline constexpr bool takes_all = false;
template <class Function, class Node, class... Arguments>
inline constexpr bool takes_all<Function, Node, function::ArgumentList<Arguments...>> =
    takes<Function, Node, Arguments...>;
template <class Node, class Event, class Function>
inline constexpr bool parameters_fit<Node, EventHandler<Event, Function>> =
    takes_all<Function, Node, typename Event::Arguments>;

template <class Node, class HandlerType>
inline constexpr bool result_fits = true;
template <class Node, class PeriodType, class Function>
requires(takes<Function, Node>) inline constexpr bool result_fits<Node, PeriodicHandler<PeriodType, Function>> =
    std::is_void_v<decltype(call(std::declval<Function&>(), std::declval<Node&>()))>;

/// Checks the parameters and the result of a handler.
template <class Node, class Handler>
constexpr void check_parameters() {
  static_assert(parameters_fit<Node, Handler>,
                "handler: its parameters are not those of its object or event, alone or after the node");
  static_assert(takes_all_of<Handler>, "handler: its parameter is not of the type of its object or a wider one");
  static_assert(
      !parameters_fit<Node, Handler> || supplies_value<Node, Handler>,
      "on_read: the handler returns the type of its object or a narrower one, a Result of it, an AbortCode or "
      "nothing");
  static_assert(!parameters_fit<Node, Handler> || result_fits<Node, Handler>, "every: the handler returns nothing");
}

}  // namespace handler_detail
}  // namespace canopen
