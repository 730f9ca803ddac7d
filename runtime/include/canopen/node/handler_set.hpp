/// The handlers of one node.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/handled.hpp"
#include "canopen/node/parts.hpp"
#include "canopen/od/access_probe.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

namespace handler_detail {

template <class Object, class List>
inline constexpr bool has_object = false;
template <class Object, class... Os>
inline constexpr bool has_object<Object, ObjectList<Os...>> =
    ((Object::index == Os::index && Object::sub_index == Os::sub_index) || ...);

template <class... Os>
[[nodiscard]] constexpr bool has_key([[maybe_unused]] std::uint32_t key, ObjectList<Os...>) {
  return ((key == object_key(Os::index, Os::sub_index)) || ...);
}

}  // namespace handler_detail

/// `Node` may be incomplete.
template <class Device, class Node, class... Handlers>
class HandlerSet {
  template <class Handler>
  using Handled = handler_detail::Handled<Device, Node, Handler>;

 public:
  /// With references to the values of some parts, in any order; the others are default-constructed (node/parts.hpp).
  template <class... Given>
  constexpr explicit HandlerSet(std::tuple<Given...> parts)
      : HandlerSet{parts, std::index_sequence_for<Handlers...>{}} {}

  /// Whether any handler is called for all objects.
  static constexpr bool takes_any_object = (Handled<Handlers>::takes_any_object || ...);

  /// Whether the value of `Object` is checked before it is written, or used after it.
  template <DictionaryObject Object>
  static constexpr bool handles_write = (handler_detail::has_object<Object, typename Handled<Handlers>::BeforeWrite> ||
                                         ...);
  template <DictionaryObject Object>
  static constexpr bool handles_written = (handler_detail::has_object<Object, typename Handled<Handlers>::AfterWrite> ||
                                           ...);

  /// Whether any handler is called after an object has been written, or before it is read.
  static constexpr bool has_written_handlers = ((Handled<Handlers>::AfterWrite::size != 0) || ...) || takes_any_object;
  /// Whether any handler is called before an object is written.
  static constexpr bool has_write_handlers = ((Handled<Handlers>::BeforeWrite::size != 0) || ...) || takes_any_object;
  /// Whether any handler supplies objects; one of all objects is called for SDO only.
  static constexpr bool has_read_handlers = ((Handled<Handlers>::Read::size != 0) || ...);
  /// Whether any handler is called before an SDO server reads an object.
  static constexpr bool has_upload_handlers = has_read_handlers || takes_any_object;
  /// Whether any handler is called when an object is read or written over the bus.
  static constexpr bool has_access_handlers = has_written_handlers || has_read_handlers || has_write_handlers;

  /// Whether the object with this key has a handler that is called before it is written.
  [[nodiscard]] static constexpr bool handles([[maybe_unused]] std::uint32_t key) {
    return takes_any_object || (handler_detail::has_key(key, typename Handled<Handlers>::BeforeWrite{}) || ...);
  }
  /// The same for after or before.
  [[nodiscard]] static constexpr bool watches([[maybe_unused]] std::uint32_t key) {
    return handles(key) || (handler_detail::has_key(key, typename Handled<Handlers>::AfterWrite{}) || ...);
  }

  /// Calls the write handlers of `Object`; returns the first abort code.
  template <DictionaryObject Object>
  AbortCode before_write([[maybe_unused]] Node& node, [[maybe_unused]] const typename Object::type& value) {
    AbortCode code = ok;
    for_each([&]<class Handler>([[maybe_unused]] Handler& handler) {
      if constexpr (handler_detail::has_object<Object, typename Handled<Handler>::BeforeWrite>) {
        AccessProbe<Device>::uses(Object::index, Object::sub_index);
        if (code == ok) code = Handled<Handler>::template before_write<Object>(handler, node, value);
      }
    });
    return code;
  }

  /// Calls the write handlers of the object with this key; returns the first abort code.
  AbortCode before_write(Node& node, std::uint32_t key, std::span<std::uint8_t> bytes) {
    AbortCode code = ok;
    std::apply(
        [&](Handlers&... handler) {
          (check_value(handler, typename Handled<Handlers>::BeforeWrite{}, node, key, bytes, code), ...);
        },
        handlers_);
    return code;
  }

  /// Calls the handlers of the object with this key after it has been written; `store` has its value.
  template <class Store>
  void after_write(Node& node, std::uint32_t key, const Store& store) {
    std::apply(
        [&](Handlers&... handler) {
          (use_value(handler, typename Handled<Handlers>::AfterWrite{}, node, key, store), ...);
        },
        handlers_);
  }

  /// Calls the read handlers of the object with this key; returns the first abort code.
  AbortCode before_read(Node& node, std::uint32_t key) {
    AbortCode code = ok;
    std::apply(
        [&](Handlers&... handler) {
          (supply_value(handler, typename Handled<Handlers>::Read{}, node, key, code), ...);
        },
        handlers_);
    return code;
  }

  /// Whether any handler has the function of an event.
  template <class Event>
  static constexpr bool has_event_function = (Handled<Handlers>::template has_event_function<Event> || ...);

  /// Calls `visit(period, call)` for each periodic function; `call()` calls it.
  template <class Visit>
  void for_each_period([[maybe_unused]] Node& node, [[maybe_unused]] Visit&& visit) {
    for_each([&]<class Handler>([[maybe_unused]] Handler& handler) {
      [&]<class... PeriodType>(handler_detail::PeriodList<PeriodType...>) {
        (visit(PeriodType::duration, [&] { Handled<Handler>::template every<PeriodType>(handler, node); }), ...);
      }(typename handler_detail::PeriodsOf<Handler>::type{});
    });
  }

  [[nodiscard]] auto& storage() const requires(storage_detail::has_storage<Handlers...>) {
    constexpr std::size_t position = [] {
      constexpr bool stored_in[] = {storage_detail::is_stored_in<Handlers>...};
      std::size_t i = 0;
      while (!stored_in[i]) ++i;
      return i;
    }();
    return *std::get<position>(handlers_).storage;
  }

  [[nodiscard]] std::tuple<Handlers...>& all() { return handlers_; }
  [[nodiscard]] const std::tuple<Handlers...>& all() const { return handlers_; }

  /// Calls all functions of an event, a row of node/functions.hpp.
  template <class Event, class... Arguments>
  void notify(Node& node, const Arguments&... arguments) {
    std::apply(
        [&](Handlers&... handler) { (Handled<Handlers>::template notify<Event>(handler, node, arguments...), ...); },
        handlers_);
  }
  /// The same while `holds()` is true: a function may end what it learns of.
  template <class Event, class Holds, class... Arguments>
  void notify_while(Node& node, const Holds& holds, const Arguments&... arguments) {
    std::apply(
        [&](Handlers&... handler) {
          ((holds() ? Handled<Handlers>::template notify<Event>(handler, node, arguments...) : void()), ...);
        },
        handlers_);
  }

 private:
  template <class... Given, std::size_t... Position>
  constexpr HandlerSet([[maybe_unused]] std::tuple<Given...>& parts, std::index_sequence<Position...>)
      : handlers_(part_detail::PartValue<Handlers, part_detail::place_of<Position, std::tuple<Handlers...>, Given...>,
                                         Given...>{parts}...) {}

  /// Whether this is the key of `Object`, which a handler uses then.
  template <class Object>
  [[nodiscard]] static constexpr bool is_for(std::uint32_t key) {
    if (key != object_key(Object::index, Object::sub_index)) return false;
    AccessProbe<Device>::uses(Object::index, Object::sub_index);
    return true;
  }

  template <class Handler, class... Os>
  static constexpr void check_value([[maybe_unused]] Handler& handler, ObjectList<Os...>, [[maybe_unused]] Node& node,
                                    [[maybe_unused]] std::uint32_t key, [[maybe_unused]] std::span<std::uint8_t> bytes,
                                    [[maybe_unused]] AbortCode& code) {
    if constexpr (Handled<Handler>::takes_any_object) {
      if (code == ok) code = handler.before_write(key, bytes);
    }
    (static_cast<void>(code == ok && is_for<Os>(key) &&
                       (code = Handled<Handler>::template before_write<Os>(handler, node,
                                                                           value_detail::value_from<Os>(bytes))) == ok),
     ...);
  }
  template <class Handler, class... Os, class Store>
  static constexpr void use_value([[maybe_unused]] Handler& handler, ObjectList<Os...>, [[maybe_unused]] Node& node,
                                  [[maybe_unused]] std::uint32_t key, [[maybe_unused]] const Store& store) {
    if constexpr (Handled<Handler>::takes_any_object) handler.after_write(key);
    ((is_for<Os>(key) ? Handled<Handler>::template after_write<Os>(handler, node, store.template get<Os>()) : void()),
     ...);
  }
  template <class Handler, class... Os>
  static constexpr void supply_value([[maybe_unused]] Handler& handler, ObjectList<Os...>, [[maybe_unused]] Node& node,
                                     [[maybe_unused]] std::uint32_t key, [[maybe_unused]] AbortCode& code) {
    if constexpr (Handled<Handler>::takes_any_object) {
      if (code == ok) code = handler.before_read(key);
    }
    (static_cast<void>(code == ok && is_for<Os>(key) &&
                       (code = Handled<Handler>::template read<Os>(handler, node)) == ok),
     ...);
  }

  template <class Visit>
  constexpr void for_each([[maybe_unused]] Visit&& visit) {
    std::apply([&](auto&... handler) { (visit(handler), ...); }, handlers_);
  }

  [[no_unique_address]] std::tuple<Handlers...> handlers_;
};

}  // namespace canopen
