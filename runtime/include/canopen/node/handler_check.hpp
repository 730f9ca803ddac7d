/// Checks the handlers of a node at its declaration: a handler that can never be called does not compile. The
/// compiler's message names the object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "canopen/base/label.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/application_check.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/node/mailbox.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

namespace handler_detail {

template <class H>
struct KnownHandler {
  static constexpr bool is_final = std::is_final_v<typename ApplicationOf<H>::type>;
  static_assert(is_handler<H> || !is_final,
                "application: the class is final; without `final` it can be one: a derived class finds its functions");
  static constexpr bool has_tick = has_uncalled_tick<typename ApplicationOf<H>::type>();
  static_assert(
      has_tick || is_handler<H> || is_final || is_application<typename ApplicationOf<H>::type>,
      "not a handler: pass on_write(object, ...), on_read(object, ...), on_state(...) or another on_...(), or "
      "an application, a class with functions of canopen/node/functions.hpp; a node-ID is NodeId{n}");
  static constexpr bool is_good = true;
};

/// The event that a handler is called for.
enum class Called : std::uint8_t { by_service, on_upload, on_download, after_download };

template <class H>
inline constexpr Called called = Called::by_service;
template <class O, class F>
inline constexpr Called called<ReadHandler<O, F>> = Called::on_upload;
template <class O, class F>
inline constexpr Called called<DomainReadHandler<O, F>> = Called::on_upload;
template <class O, class F>
inline constexpr Called called<WriteHandler<O, F>> = Called::on_download;
template <class O, class F>
inline constexpr Called called<WrittenHandler<O, F>> = Called::after_download;
template <class O, class F>
inline constexpr Called called<DomainWriteHandler<O, F>> = Called::on_download;

/// Whether two handlers are called for the same event of the same object.
template <class H, class Other>
[[nodiscard]] constexpr bool is_same_call() {
  if constexpr (called<H> == called<Other> && called<H> != Called::by_service) {
    return H::object::index == Other::object::index && H::object::sub_index == Other::object::sub_index;
  } else {
    return false;
  }
}

/// The handlers of one object: the event they are called for, its entry in the device's dictionary, and their number.
template <class Object, class Label, Called When, entry::Word Entry, std::size_t Count>
struct ObjectHandler {
  static constexpr bool exists = Entry > Dictionary::no_sub_index;
  static_assert(exists, "handler: this device does not have the object");
  static_assert(!exists || When == Called::on_upload || (Entry & entry::writable) != 0,
                "on_write: the object is ro or const, so that the handler can never be called");
  static_assert(!exists || When != Called::on_upload || (Entry & entry::readable) != 0,
                "on_read: the object is wo, so that the handler can never be called");
  static_assert(Count == 1, "handler: the object has two of them; join them to one");
  static constexpr bool is_good = true;
};

/// The objects without which a service never calls its handler. Handlers of error control are accepted by each device:
/// code that several devices share passes those of heartbeat and of guarding, of which a device may have one.
template <class H, class Event>
inline constexpr bool is_of = false;
template <class Event, class F>
inline constexpr bool is_of<EventHandler<Event, F>, Event> = true;

template <class Device, class H>
struct ServiceHandler {
  static constexpr bool has(std::uint16_t index) { return Device::dictionary.has(index, 0); }
  static_assert(!is_of<H, function::OnSync> || has(0x1005),
                "on_sync: this device does not have 1005h, so that the handler can never be called");
  static_assert(!is_of<H, function::OnTimeOfDay> || has(0x1012),
                "on_time_of_day: this device does not have 1012h, so that the handler can never be called");
  static_assert(!is_of<H, function::OnEmergency> || has(0x1028),
                "on_emergency: this device does not have 1028h, so that the handler can never be called");
  static constexpr bool is_good = KnownHandler<H>::is_good;
};

/// A mailbox with objects of this device.
template <class Device, class H>
inline constexpr bool mailbox_fits = true;
template <class Device, class M>
inline constexpr bool mailbox_fits<Device, ValuesFrom<M>> = M::template fits<Device>;
template <class Device, class H>
struct MailboxHandler {
  static_assert(mailbox_fits<Device, H>, "values_from: this device does not have an object of the mailbox");
  static constexpr bool is_good = true;
};

template <class Device, class Node, class H, class... Handlers>
[[nodiscard]] constexpr bool check_handler() {
  using Application = typename ApplicationOf<H>::type;
  if constexpr (is_application<Application>) {
    return check_application<Device, Node, Application>();
  } else if constexpr (called<H> != Called::by_service) {
    using Object = typename H::object;
    constexpr std::size_t count = (std::size_t{is_same_call<H, Handlers>()} + ...);
    return ObjectHandler<Object, pdo_detail::LabelOf<Object>, called<H>,
                         Device::dictionary.find(Object::index, Object::sub_index), count>::is_good;
  } else {
    return MailboxHandler<Device, H>::is_good && ServiceHandler<Device, H>::is_good;
  }
}

}  // namespace handler_detail

/// Whether each of these handlers can be called in a node of this device; does not compile if one cannot. `Node` may be
/// incomplete.
template <class Device, class Node, class... Handlers>
[[nodiscard]] constexpr bool checked_handlers() {
  return (true && ... && handler_detail::check_handler<Device, Node, Handlers, Handlers...>());
}

namespace handler_detail {

/// A handler whose callable accepts the arguments of its event, alone or after the node.
template <class H, bool Fits>
struct HandlerParameters {
  static_assert(Fits, "handler: its parameters are not those of its object or event, alone or after the node");
  static constexpr bool is_good = true;
};

template <class Node, class H>
inline constexpr bool parameters_fit = true;
template <class Node, class O, class F>
inline constexpr bool parameters_fit<Node, WriteHandler<O, F>> = takes<F, Node, typename O::type>;
template <class Node, class O, class F>
inline constexpr bool parameters_fit<Node, WrittenHandler<O, F>> = takes<F, Node, typename O::type>;
template <class Node, class O, class F>
inline constexpr bool parameters_fit<Node, ReadHandler<O, F>> = takes<F, Node>;
template <class Node, class P, class F>
inline constexpr bool parameters_fit<Node, PeriodicHandler<P, F>> = takes<F, Node>;
template <class F, class Node, class List>
inline constexpr bool takes_all = false;
template <class F, class Node, class... Arguments>
inline constexpr bool takes_all<F, Node, function::ArgumentList<Arguments...>> = takes<F, Node, Arguments...>;
template <class Node, class Event, class F>
inline constexpr bool parameters_fit<Node, EventHandler<Event, F>> = takes_all<F, Node, typename Event::Arguments>;

/// The result of a periodic handler.
template <class H, bool IsNothing>
struct PeriodicHandlerResult {
  static_assert(IsNothing, "every: the handler returns nothing");
  static constexpr bool is_good = true;
};

template <class Node, class H>
inline constexpr bool result_fits = true;
template <class Node, class P, class F>
requires(takes<F, Node>) inline constexpr bool result_fits<Node, PeriodicHandler<P, F>> =
    std::is_void_v<decltype(call(std::declval<F&>(), std::declval<Node&>()))>;

}  // namespace handler_detail

/// Whether the node can call each of these handlers. `Node` must be complete, because the compiler instantiates generic
/// lambdas with it.
template <class Node, class... Handlers>
[[nodiscard]] constexpr bool checked_parameters() {
  return (true && ... &&
          (handler_detail::HandlerParameters<Handlers, handler_detail::parameters_fit<Node, Handlers>>::is_good &&
           handler_detail::PeriodicHandlerResult<Handlers, handler_detail::result_fits<Node, Handlers>>::is_good));
}

}  // namespace canopen
