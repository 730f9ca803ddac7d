/// Which objects and events each handler of a node handles, and how it is called. An application class handles several:
/// node/application.hpp.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/od/object_list.hpp"

namespace canopen::handler_detail {

template <class Type>
inline constexpr bool is_result = false;
template <class Type>
inline constexpr bool is_result<Result<Type>> = true;

/// Calls a write handler and returns its answer as an abort code.
template <class Ask>
[[nodiscard]] constexpr AbortCode code_of(Ask&& ask) {
  using Answer = decltype(ask());
  if constexpr (std::is_same_v<Answer, AbortCode>) {
    return ask();
  } else if constexpr (std::is_same_v<Answer, Result<void>>) {
    return ask().abort_code();
  } else {
    static_assert(std::is_void_v<Answer>, "a write handler returns an AbortCode, a Result<void> or nothing");
    ask();
    return ok;
  }
}

/// Calls a read handler and sets the value that it returns.
template <DictionaryObject Object, class Node, class Ask>
[[nodiscard]] constexpr AbortCode supply(Node& node, Ask&& ask) {
  using Answer = decltype(ask());
  if constexpr (std::is_void_v<Answer>) {
    ask();
    return ok;
  } else if constexpr (std::is_same_v<Answer, AbortCode>) {
    return ask();
  } else if constexpr (is_result<Answer>) {
    const Answer answer = ask();
    return answer ? node.template set<Object>(*answer) : answer.abort_code();
  } else {
    return node.template set<Object>(ask());
  }
}

/// What a handler without further specialization handles: nothing.
struct HandlesNothing {
  using BeforeWrite = ObjectList<>;  ///< objects, before a received value is stored
  using AfterWrite = ObjectList<>;   ///< the same, after it has been stored
  using Read = ObjectList<>;         ///< objects, before they are sent
  /// Whether the handler itself has the functions `before_write(key, bytes)`, `after_write(key)` and
  /// `before_read(key)`, for all objects; a device with a sheet only (od/sheet.hpp).
  static constexpr bool takes_any_object = false;
  /// Whether the handler has the function of an event.
  template <class Event>
  static constexpr bool has_event_function = false;

  template <DictionaryObject Object, class Handler, class Node>
  static constexpr AbortCode before_write(Handler&, Node&, const typename Object::type&) {
    return ok;
  }
  template <DictionaryObject Object, class Handler, class Node>
  static constexpr void after_write(Handler&, Node&, const typename Object::type&) {}
  template <DictionaryObject Object, class Handler, class Node>
  static constexpr AbortCode read(Handler&, Node&) {
    return ok;
  }
  /// Calls the function of an event, if the handler has it.
  template <class Event, class Handler, class Node, class... Arguments>
  static constexpr void notify(Handler&, Node&, const Arguments&...) {}
  /// Calls the function of one of its periods.
  template <class PeriodType, class Handler, class Node>
  static constexpr void every(Handler&, Node&) {}
};

/// `Node` may be incomplete.
template <class Device, class Node, class Handler>
struct Handled : HandlesNothing {};

template <class Device, class Node, class Object, class Function>
struct Handled<Device, Node, WriteHandler<Object, Function>> : HandlesNothing {
  using BeforeWrite = ObjectList<Object>;
  /// A profile names an object by the type of its raw number.
  template <DictionaryObject Written>
  static constexpr AbortCode before_write(WriteHandler<Object, Function>& handler, Node& node,
                                          const typename Written::type& value) {
    if constexpr (std::is_same_v<typename Written::type, typename Object::type>) {
      return code_of([&]() -> decltype(auto) { return call(handler.call, node, value); });
    } else {
      return before_write<Object>(handler, node, from_raw<typename Object::type>(to_raw(value)));
    }
  }
};

template <class Device, class Node, class Object, class Function>
struct Handled<Device, Node, WrittenHandler<Object, Function>> : HandlesNothing {
  using AfterWrite = ObjectList<Object>;
  template <DictionaryObject>
  static constexpr void after_write(WrittenHandler<Object, Function>& handler, Node& node,
                                    const typename Object::type& value) {
    call(handler.call, node, value);
  }
};

template <class Device, class Node, class Object, class Function>
struct Handled<Device, Node, ReadHandler<Object, Function>> : HandlesNothing {
  using Read = ObjectList<Object>;
  template <DictionaryObject>
  static constexpr AbortCode read(ReadHandler<Object, Function>& handler, Node& node) {
    return supply<Object>(node, [&]() -> decltype(auto) { return call(handler.call, node); });
  }
};

template <class Device, class Node, class Event, class Function>
struct Handled<Device, Node, EventHandler<Event, Function>> : HandlesNothing {
  template <class Asked>
  static constexpr bool has_event_function = std::is_same_v<Asked, Event>;
  template <class Notified, class... Arguments>
  static constexpr void notify(EventHandler<Event, Function>& handler, Node& node, const Arguments&... arguments) {
    if constexpr (std::is_same_v<Notified, Event>) call(handler.call, node, arguments...);
  }
};

template <class Device, class Node, class PeriodType, class Function>
struct Handled<Device, Node, PeriodicHandler<PeriodType, Function>> : HandlesNothing {
  template <class>
  static constexpr void every(PeriodicHandler<PeriodType, Function>& handler, Node& node) {
    call(handler.call, node);
  }
};

}  // namespace canopen::handler_detail
